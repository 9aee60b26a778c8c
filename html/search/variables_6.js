var searchData=
[
  ['gains_0',['gains',['../structossa_1_1physics_1_1CharacterFilterOptions.html#ac59e0b5516211e7fcdac657069d4173c',1,'ossa::physics::CharacterFilterOptions']]],
  ['gravity_5fm_5fs2_1',['gravity_m_s2',['../structossa_1_1physics_1_1WorldOptions.html#ab7dede4d3fdf703a342720379e4f0ab3',1,'ossa::physics::WorldOptions']]],
  ['grazing_5fcos_2',['grazing_cos',['../structossa_1_1depth_1_1StructuredLightOptions.html#a93b181f00cbe16c428bd2b0005fe7926',1,'ossa::depth::StructuredLightOptions']]],
  ['gross_5fm_3',['gross_m',['../structossa_1_1recon_1_1PoseCorrectionOptions.html#aec2cf5f77801e722489a5faeaf6b384e',1,'ossa::recon::PoseCorrectionOptions']]],
  ['group_4',['group',['../structossa_1_1recon_1_1PosturePair.html#a6cbe1980f4700a33baec70b2994d7fca',1,'ossa::recon::PosturePair']]],
  ['growth_5fm_5',['growth_m',['../structossa_1_1depth_1_1SceneOptions.html#a830b0d4aa72fddcf18b4ce1edfe4510a',1,'ossa::depth::SceneOptions']]],
  ['guesses_6',['guesses',['../structossa_1_1recon_1_1PriorObservation.html#a8afd790d02366e7ef7481bb4085f1736',1,'ossa::recon::PriorObservation']]]
];
