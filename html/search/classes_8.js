var searchData=
[
  ['jointanchor_0',['JointAnchor',['../structossa_1_1recon_1_1JointAnchor.html',1,'ossa::recon']]],
  ['jointrecord_1',['JointRecord',['../structossa_1_1recon_1_1JointRecord.html',1,'ossa::recon']]],
  ['judgedbones_2',['JudgedBones',['../structossa_1_1recon_1_1JudgedBones.html',1,'ossa::recon']]]
];
