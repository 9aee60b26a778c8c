var searchData=
[
  ['values_0',['values',['../structossa_1_1recon_1_1BvhFile.html#a443a19113ac3609e91f7c94beb6137d7',1,'ossa::recon::BvhFile::values()'],['../structossa_1_1recon_1_1Spectrum.html#a6fd67b7f7269916bcfa9c0873da756e5',1,'ossa::recon::Spectrum::values()']]],
  ['variance_1',['variance',['../structossa_1_1recon_1_1GaussianPrediction.html#a137f534973cfcf1a14894a0079836d67',1,'ossa::recon::GaussianPrediction']]],
  ['variations_2',['variations',['../structossa_1_1recon_1_1AuthoredOptions.html#a58851490dfbaa75b90f0476f558a8d11',1,'ossa::recon::AuthoredOptions']]],
  ['vectors_3',['vectors',['../structossa_1_1recon_1_1Spectrum.html#a6d7d4343a6e700206601b6a5ad981f05',1,'ossa::recon::Spectrum']]],
  ['vertices_5fm_4',['vertices_m',['../structossa_1_1depth_1_1TriangleMesh.html#a7d284ac1bd61670c544d864a686ce4f8',1,'ossa::depth::TriangleMesh']]],
  ['visible_5',['visible',['../structossa_1_1forest_1_1ProposalTarget.html#a671e6694a226e0302f0bb037c631d365',1,'ossa::forest::ProposalTarget::visible()'],['../structossa_1_1recon_1_1JointRecord.html#ac47bf073fddfcbdaa186b38aa1341acc',1,'ossa::recon::JointRecord::visible()']]],
  ['vote_5fdepth_6',['vote_depth',['../structossa_1_1forest_1_1TrainOptions.html#ac29cb835f0124df51908d8d08d824ea5',1,'ossa::forest::TrainOptions']]],
  ['vote_5fradius_5fm_7',['vote_radius_m',['../structossa_1_1forest_1_1ProposalTarget.html#a3711c5d8a811abf18981a8fab03ab993',1,'ossa::forest::ProposalTarget']]],
  ['vote_5fsharpness_5fm_8',['vote_sharpness_m',['../structossa_1_1forest_1_1ProposalTarget.html#a6d20959676173943fd350db2df79144e',1,'ossa::forest::ProposalTarget']]],
  ['votes_9',['votes',['../structossa_1_1forest_1_1Tree.html#a440edee74d3b9b76c8650a8c573eabbd',1,'ossa::forest::Tree']]]
];
