var searchData=
[
  ['jointorientations_0',['JointOrientations',['../namespaceossa_1_1recon.html#a918f8c4341847a3b6d08dd68781aa625',1,'ossa::recon']]],
  ['jointset_1',['JointSet',['../namespaceossa_1_1recon.html#a42c79dca946270bac9f47c17a4b55c3e',1,'ossa::recon']]],
  ['jointweights_2',['JointWeights',['../namespaceossa_1_1recon.html#aa6a50ab435d3187c57b653ec70037779',1,'ossa::recon']]]
];
