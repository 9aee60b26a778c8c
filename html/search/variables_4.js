var searchData=
[
  ['edge_5fdropout_0',['edge_dropout',['../structossa_1_1depth_1_1StructuredLightOptions.html#a950e96dc4997b6f3764d6dd3eefa9f1c',1,'ossa::depth::StructuredLightOptions']]],
  ['edge_5fmixed_1',['edge_mixed',['../structossa_1_1depth_1_1StructuredLightOptions.html#af88b042f73f56b458e97e1aa6f672a14',1,'ossa::depth::StructuredLightOptions']]],
  ['end_5fsites_2',['end_sites',['../structossa_1_1recon_1_1BvhJoint.html#a8d469608ced69056e32fc52872c88b7f',1,'ossa::recon::BvhJoint']]],
  ['entry_5fbegin_3',['entry_begin',['../structossa_1_1forest_1_1Tree.html#a1c09de8bd35adea68436283287be7d30',1,'ossa::forest::Tree']]],
  ['epochs_4',['epochs',['../structossa_1_1forest_1_1NetworkOptions.html#ae3aa8b8789fc5abac0346e8b2251e8ad',1,'ossa::forest::NetworkOptions::epochs()'],['../structossa_1_1forest_1_1RefinementOptions.html#a1f94a71e3189ffca18d487983c6429b0',1,'ossa::forest::RefinementOptions::epochs()']]],
  ['evaluations_5',['evaluations',['../structossa_1_1forest_1_1TrainSummary.html#a02b144b705f4cb19cbe467711e798e34',1,'ossa::forest::TrainSummary']]],
  ['evidence_5fscale_6',['evidence_scale',['../structossa_1_1forest_1_1ForestData.html#aa15824f1e47e3b21c2f704180d9e74a5',1,'ossa::forest::ForestData']]],
  ['expected_7',['expected',['../structossa_1_1recon_1_1BestConstants.html#a6228cde4bcafff219c50ea9a6c721e11',1,'ossa::recon::BestConstants']]],
  ['extend_5fdatabase_8',['extend_database',['../structossa_1_1recon_1_1LocalPcaOptions.html#a5d6438e002603902322c8570e17992d2',1,'ossa::recon::LocalPcaOptions']]]
];
