var searchData=
[
  ['depthtolerance_0',['DepthTolerance',['../namespaceossa_1_1depth.html#a6da911c36c610ed5a1c514b25fa7077b',1,'ossa::depth']]],
  ['dress_1',['Dress',['../classossa_1_1recon_1_1Wardrobe.html#a172ba903e25a4c875d7a58b43b8f13ca',1,'ossa::recon::Wardrobe']]]
];
