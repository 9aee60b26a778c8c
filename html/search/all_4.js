var searchData=
[
  ['edge_5fdropout_0',['edge_dropout',['../structossa_1_1depth_1_1StructuredLightOptions.html#a950e96dc4997b6f3764d6dd3eefa9f1c',1,'ossa::depth::StructuredLightOptions']]],
  ['edge_5fmixed_1',['edge_mixed',['../structossa_1_1depth_1_1StructuredLightOptions.html#af88b042f73f56b458e97e1aa6f672a14',1,'ossa::depth::StructuredLightOptions']]],
  ['edge_5fthreshold_5fm_2',['edge_threshold_m',['../classossa_1_1recon_1_1PostureDatabase.html#a93e5571802c1d970cab7a08a2b538c83',1,'ossa::recon::PostureDatabase']]],
  ['empty_3',['empty',['../structossa_1_1recon_1_1RectifiedNetwork.html#aab718b06d6be356be5aba2e679305e51',1,'ossa::recon::RectifiedNetwork']]],
  ['encodecolourpng_4',['EncodeColourPng',['../namespaceossa_1_1depth.html#a3c8c89ba485f2b63f796c8db5f0f3330',1,'ossa::depth']]],
  ['end_5fsites_5',['end_sites',['../structossa_1_1recon_1_1BvhJoint.html#a8d469608ced69056e32fc52872c88b7f',1,'ossa::recon::BvhJoint']]],
  ['entry_5fbegin_6',['entry_begin',['../structossa_1_1forest_1_1Tree.html#a1c09de8bd35adea68436283287be7d30',1,'ossa::forest::Tree']]],
  ['epochs_7',['epochs',['../structossa_1_1forest_1_1NetworkOptions.html#ae3aa8b8789fc5abac0346e8b2251e8ad',1,'ossa::forest::NetworkOptions::epochs()'],['../structossa_1_1forest_1_1RefinementOptions.html#a1f94a71e3189ffca18d487983c6429b0',1,'ossa::forest::RefinementOptions::epochs()']]],
  ['estimate_8',['Estimate',['../classossa_1_1recon_1_1LinearFilter.html#a24fdf4b4bc132692cd3404fc86bbfb59',1,'ossa::recon::LinearFilter']]],
  ['evaluations_9',['evaluations',['../structossa_1_1forest_1_1TrainSummary.html#a02b144b705f4cb19cbe467711e798e34',1,'ossa::forest::TrainSummary']]],
  ['evidence_5fscale_10',['evidence_scale',['../structossa_1_1forest_1_1ForestData.html#aa15824f1e47e3b21c2f704180d9e74a5',1,'ossa::forest::ForestData']]],
  ['expected_11',['expected',['../structossa_1_1recon_1_1BestConstants.html#a6228cde4bcafff219c50ea9a6c721e11',1,'ossa::recon::BestConstants']]],
  ['expectend_12',['ExpectEnd',['../classossa_1_1PayloadReader.html#a122806bab4230d2d38ab6536d7a89af8',1,'ossa::PayloadReader']]],
  ['extend_5fdatabase_13',['extend_database',['../structossa_1_1recon_1_1LocalPcaOptions.html#a5d6438e002603902322c8570e17992d2',1,'ossa::recon::LocalPcaOptions']]]
];
