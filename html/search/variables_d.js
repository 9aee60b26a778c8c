var searchData=
[
  ['name_0',['name',['../structossa_1_1forest_1_1ProposalTarget.html#a5d102139db966024ef2c1d1cf17b0726',1,'ossa::forest::ProposalTarget::name()'],['../structossa_1_1recon_1_1MotionClip.html#a5f8a0989b329e467cdb41fec365d546c',1,'ossa::recon::MotionClip::name()'],['../structossa_1_1recon_1_1SkeletonClip.html#a071ec4793897d9127ea7756c55145422',1,'ossa::recon::SkeletonClip::name()']]],
  ['near_5frange_1',['near_range',['../structossa_1_1tracker_1_1TrackerOptions.html#aac5fdd0e310117345c4b73eb5a6ba23c',1,'ossa::tracker::TrackerOptions']]],
  ['nearby_5fmodels_2',['nearby_models',['../structossa_1_1recon_1_1GaussianProcessOptions.html#a0a55563b415279b28620a8673bb43140',1,'ossa::recon::GaussianProcessOptions']]],
  ['nearest_5fm_3',['nearest_m',['../structossa_1_1depth_1_1StructuredLightOptions.html#a15138daf813eb4d020852c7a0e1ed659',1,'ossa::depth::StructuredLightOptions']]],
  ['neighbours_4',['neighbours',['../structossa_1_1recon_1_1LocalPcaOptions.html#ad7907820b5d9805a3e4b6314f1fcf2a1',1,'ossa::recon::LocalPcaOptions']]],
  ['network_5',['network',['../structossa_1_1recon_1_1PosturePrior.html#a77f1bfd2418129f627e2075df8440619',1,'ossa::recon::PosturePrior']]],
  ['new_5fborder_5f1_5fm2_6',['new_border_1_m2',['../structossa_1_1depth_1_1ReidentifyOptions.html#a04a6988815110a2697f23675de08f1a2',1,'ossa::depth::ReidentifyOptions']]],
  ['no_5fspeed_7',['no_speed',['../structossa_1_1recon_1_1ReliabilityOptions.html#a8161d9ea7d6b6c83d8ea6a8c9298f911',1,'ossa::recon::ReliabilityOptions']]],
  ['node_5fpixels_8',['node_pixels',['../structossa_1_1forest_1_1TrainOptions.html#a722ec3432b52cda846a34cf7d66d4f58',1,'ossa::forest::TrainOptions']]],
  ['nodes_9',['nodes',['../structossa_1_1forest_1_1TrainProgress.html#a38c736a32f4152b9d67a63aa87af3460',1,'ossa::forest::TrainProgress']]],
  ['noise_5fm_10',['noise_m',['../structossa_1_1forest_1_1Arrangement.html#abb84c34e754a87f73c8a95b642f88612',1,'ossa::forest::Arrangement::noise_m()'],['../structossa_1_1recon_1_1BestConstants.html#a79ef2e3f11b4d7b5258cb6b082d6fa37',1,'ossa::recon::BestConstants::noise_m()']]],
  ['normal_11',['normal',['../structossa_1_1depth_1_1FlatPiece.html#a3181a5a4ac48168a096098f0e40bd4ec',1,'ossa::depth::FlatPiece']]],
  ['normals_12',['normals',['../structossa_1_1recon_1_1ShapedBody.html#a6f37823378c17577454cbeb575146745',1,'ossa::recon::ShapedBody']]]
];
