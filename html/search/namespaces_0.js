var searchData=
[
  ['depth_0',['depth',['../namespaceossa_1_1depth.html',1,'ossa']]],
  ['recon_1',['recon',['../namespaceossa_1_1recon.html',1,'ossa']]],
  ['tracker_2',['tracker',['../namespaceossa_1_1tracker.html',1,'ossa']]]
];
