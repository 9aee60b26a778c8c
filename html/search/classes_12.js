var searchData=
[
  ['virtualdeviceoptions_0',['VirtualDeviceOptions',['../structossa_1_1depth_1_1VirtualDeviceOptions.html',1,'ossa::depth']]],
  ['vote_1',['Vote',['../structossa_1_1forest_1_1Vote.html',1,'ossa::forest']]]
];
