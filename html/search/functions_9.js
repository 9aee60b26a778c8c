var searchData=
[
  ['joinbehind_0',['JoinBehind',['../namespaceossa_1_1depth.html#aa17654edfeed17f7bd688e0a96e6f1aa',1,'ossa::depth']]],
  ['joinbelow_1',['JoinBelow',['../namespaceossa_1_1depth.html#acaf6b3a3ed493b2089eb900e48811e25',1,'ossa::depth']]],
  ['joinbyhistory_2',['JoinByHistory',['../namespaceossa_1_1depth.html#af8794c05931c05bd14eada88cd4db822',1,'ossa::depth']]],
  ['joincandidates_3',['JoinCandidates',['../namespaceossa_1_1depth.html#aab19fc02ca87591037dca4a83f96a52e',1,'ossa::depth']]],
  ['joinpieces_4',['JoinPieces',['../namespaceossa_1_1depth.html#a347602c30e277f08c2c12f5cca804c5b',1,'ossa::depth']]],
  ['jointfeature_5',['JointFeature',['../namespaceossa_1_1recon.html#a9f45f91ef3da8b63abb45075b2028022',1,'ossa::recon']]],
  ['jointsof_6',['JointsOf',['../namespaceossa_1_1recon.html#adf67783695ac958e958c2854d8fcc04f',1,'ossa::recon']]]
];
