var searchData=
[
  ['thinned_0',['Thinned',['../namespaceossa_1_1recon.html#a8c61a6bab433961522bfbd9ad69cf4ce',1,'ossa::recon']]],
  ['tiltdown_5frad_1',['TiltDown_rad',['../structossa_1_1depth_1_1FloorPlane.html#a5a5188629ef56e270eba8423da2d535e',1,'ossa::depth::FloorPlane']]],
  ['trackedpostureof_2',['TrackedPostureOf',['../namespaceossa_1_1recon.html#ae34e024b8138719ab7646d58325104b7',1,'ossa::recon']]],
  ['tracker_3',['Tracker',['../classossa_1_1tracker_1_1Tracker.html#aacd62246cc0a30dafa5599fe43a64795',1,'ossa::tracker::Tracker']]],
  ['triangle_5fpart_4',['triangle_part',['../classossa_1_1recon_1_1BodyModel.html#a0fdf0aec477b4fcdf6f33a226ed805eb',1,'ossa::recon::BodyModel']]]
];
