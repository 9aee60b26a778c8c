var searchData=
[
  ['values_0',['values',['../structossa_1_1recon_1_1BvhFile.html#a443a19113ac3609e91f7c94beb6137d7',1,'ossa::recon::BvhFile::values()'],['../structossa_1_1recon_1_1Spectrum.html#a6fd67b7f7269916bcfa9c0873da756e5',1,'ossa::recon::Spectrum::values()']]],
  ['variance_1',['variance',['../structossa_1_1recon_1_1GaussianPrediction.html#a137f534973cfcf1a14894a0079836d67',1,'ossa::recon::GaussianPrediction']]],
  ['variations_2',['variations',['../structossa_1_1recon_1_1AuthoredOptions.html#a58851490dfbaa75b90f0476f558a8d11',1,'ossa::recon::AuthoredOptions']]],
  ['vectors_3',['vectors',['../structossa_1_1recon_1_1Spectrum.html#a6d7d4343a6e700206601b6a5ad981f05',1,'ossa::recon::Spectrum']]],
  ['vertex_5flayer_4',['vertex_layer',['../classossa_1_1recon_1_1BodyModel.html#a56c80be5bb0fb03fbcce72d5795ea507',1,'ossa::recon::BodyModel']]],
  ['vertex_5fpart_5',['vertex_part',['../classossa_1_1recon_1_1BodyModel.html#a149501a3cf8e524787c9f169a8ae472a',1,'ossa::recon::BodyModel']]],
  ['vertices_5fm_6',['vertices_m',['../structossa_1_1depth_1_1TriangleMesh.html#a7d284ac1bd61670c544d864a686ce4f8',1,'ossa::depth::TriangleMesh']]],
  ['virtualdeviceoptions_7',['VirtualDeviceOptions',['../structossa_1_1depth_1_1VirtualDeviceOptions.html',1,'ossa::depth']]],
  ['visible_8',['visible',['../structossa_1_1forest_1_1ProposalTarget.html#a671e6694a226e0302f0bb037c631d365',1,'ossa::forest::ProposalTarget::visible()'],['../structossa_1_1recon_1_1JointRecord.html#ac47bf073fddfcbdaa186b38aa1341acc',1,'ossa::recon::JointRecord::visible()']]],
  ['vote_9',['Vote',['../structossa_1_1forest_1_1Vote.html',1,'ossa::forest']]],
  ['vote_5fdepth_10',['vote_depth',['../structossa_1_1forest_1_1TrainOptions.html#ac29cb835f0124df51908d8d08d824ea5',1,'ossa::forest::TrainOptions']]],
  ['vote_5fradius_5fm_11',['vote_radius_m',['../structossa_1_1forest_1_1ProposalTarget.html#a3711c5d8a811abf18981a8fab03ab993',1,'ossa::forest::ProposalTarget']]],
  ['vote_5fsharpness_5fm_12',['vote_sharpness_m',['../structossa_1_1forest_1_1ProposalTarget.html#a6d20959676173943fd350db2df79144e',1,'ossa::forest::ProposalTarget']]],
  ['votes_13',['votes',['../structossa_1_1forest_1_1Tree.html#a440edee74d3b9b76c8650a8c573eabbd',1,'ossa::forest::Tree']]]
];
