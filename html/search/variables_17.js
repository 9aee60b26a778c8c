var searchData=
[
  ['z_5fm_0',['z_m',['../structossa_1_1depth_1_1UserTrack.html#aee8a46ec7afc10af03eef97106b9b349',1,'ossa::depth::UserTrack']]]
];
