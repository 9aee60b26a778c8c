var searchData=
[
  ['hair_5fm_0',['hair_m',['../structossa_1_1recon_1_1Clothing.html#ae5f78ae51ed16b125621790f7f805d73',1,'ossa::recon::Clothing']]],
  ['has_5fhead_1',['has_head',['../structossa_1_1depth_1_1Candidate.html#ade65949d07f780a9f6fa3cecdfb6090e',1,'ossa::depth::Candidate']]],
  ['height_2',['height',['../structossa_1_1depth_1_1Camera.html#ae7661b96ca555e388bed2070162f6339',1,'ossa::depth::Camera::height()'],['../structossa_1_1depth_1_1PointGrid.html#ac57a573c803c2009b956977f7fd95409',1,'ossa::depth::PointGrid::height()'],['../structossa_1_1recon_1_1BodyShape.html#a9079aa4149124ccfb072221f55c0aec2',1,'ossa::recon::BodyShape::height()']]],
  ['height_5fm_3',['height_m',['../structossa_1_1recon_1_1ShapedBody.html#ab99e34448402de5775cc2c99c4b3e375',1,'ossa::recon::ShapedBody']]],
  ['hidden_4',['hidden',['../structossa_1_1forest_1_1NetworkOptions.html#ace2b2de7b6598bf8ee8722fe0aab39fc',1,'ossa::forest::NetworkOptions::hidden()'],['../structossa_1_1forest_1_1RefinementOptions.html#a2d04b1895580b02a3a55165593399471',1,'ossa::forest::RefinementOptions::hidden()']]],
  ['hidden_5fshare_5',['hidden_share',['../structossa_1_1depth_1_1Candidate.html#a0386a47f090af402984866b593185f45',1,'ossa::depth::Candidate']]],
  ['high_5fm_6',['high_m',['../structossa_1_1depth_1_1Region.html#a24966bc3a861cc7d29b8ee8770d24bbe',1,'ossa::depth::Region']]],
  ['hinges_7',['hinges',['../structossa_1_1physics_1_1CharacterFilterOptions.html#ae8d2c561046623aeea15f29b9292b8ec',1,'ossa::physics::CharacterFilterOptions::hinges()'],['../structossa_1_1physics_1_1CharacterOptions.html#ae7c99760bc33fb524b6342038ecc1a19',1,'ossa::physics::CharacterOptions::hinges()'],['../structossa_1_1tracker_1_1MechanicsBuild.html#a662023c76ee1f1cf3ecfa689fc87f153',1,'ossa::tracker::MechanicsBuild::hinges()']]]
];
