var searchData=
[
  ['mechanicsbuild_0',['MechanicsBuild',['../structossa_1_1tracker_1_1MechanicsBuild.html',1,'ossa::tracker']]],
  ['mocapoptions_1',['MocapOptions',['../structossa_1_1recon_1_1MocapOptions.html',1,'ossa::recon']]],
  ['motionclip_2',['MotionClip',['../structossa_1_1recon_1_1MotionClip.html',1,'ossa::recon']]]
];
