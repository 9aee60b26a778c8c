var searchData=
[
  ['wardrobe_0',['Wardrobe',['../classossa_1_1recon_1_1Wardrobe.html',1,'ossa::recon']]],
  ['weightbytes_1',['WeightBytes',['../structossa_1_1recon_1_1WeightBytes.html',1,'ossa::recon']]],
  ['weightline_2',['WeightLine',['../structossa_1_1recon_1_1WeightLine.html',1,'ossa::recon']]],
  ['world_3',['World',['../classossa_1_1physics_1_1World.html',1,'ossa::physics']]],
  ['worldoptions_4',['WorldOptions',['../structossa_1_1physics_1_1WorldOptions.html',1,'ossa::physics']]]
];
