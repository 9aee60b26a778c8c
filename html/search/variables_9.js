var searchData=
[
  ['jitter_5fradius_5fm_0',['jitter_radius_m',['../structossa_1_1tracker_1_1SmoothingOptions.html#a2245c7dbd88388e18f89b7182b6cf182',1,'ossa::tracker::SmoothingOptions']]],
  ['joint_5flimits_1',['joint_limits',['../structossa_1_1physics_1_1CharacterFilterOptions.html#acb7c9847f6b27a186c448fcaa4501660',1,'ossa::physics::CharacterFilterOptions::joint_limits()'],['../structossa_1_1physics_1_1CharacterOptions.html#aeecd062626762d14baffdd660eb00c59',1,'ossa::physics::CharacterOptions::joint_limits()'],['../structossa_1_1tracker_1_1MechanicsBuild.html#aca0fe578c9d7df9ac1b4f7abe04a3f4c',1,'ossa::tracker::MechanicsBuild::joint_limits()']]],
  ['joint_5fm_2',['joint_m',['../structossa_1_1recon_1_1ShapedBody.html#ab0058c08bd5c106a5f7f26b90a388231',1,'ossa::recon::ShapedBody']]],
  ['joints_3',['joints',['../structossa_1_1recon_1_1BodyRecord.html#a73c89ff5685e551b2ea3109abfa64d7e',1,'ossa::recon::BodyRecord']]],
  ['joints_5fm_4',['joints_m',['../structossa_1_1recon_1_1Looked.html#a6ce0565cadd91f469655bfaa951ebd79',1,'ossa::recon::Looked']]]
];
