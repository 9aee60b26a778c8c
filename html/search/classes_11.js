var searchData=
[
  ['usertrack_0',['UserTrack',['../structossa_1_1depth_1_1UserTrack.html',1,'ossa::depth']]]
];
