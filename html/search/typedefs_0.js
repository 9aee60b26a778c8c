var searchData=
[
  ['bonelengths_0',['BoneLengths',['../namespaceossa_1_1recon.html#a8380f04bb44fea7f5a04f84f974d60c1',1,'ossa::recon']]],
  ['bonesofpeople_1',['BonesOfPeople',['../namespaceossa_1_1recon.html#a0fa6fb71606c0c7ab8cc9e85268a2fa4',1,'ossa::recon']]]
];
