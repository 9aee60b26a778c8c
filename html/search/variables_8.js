var searchData=
[
  ['incidence_0',['incidence',['../structossa_1_1depth_1_1RenderedImage.html#ab7e089866d2ca81dd86be61a50e57db8',1,'ossa::depth::RenderedImage']]],
  ['incremental_1',['incremental',['../structossa_1_1recon_1_1GaussianProcessOptions.html#a2f33c7a739a08ad6ed6738f96fdcf432',1,'ossa::recon::GaussianProcessOptions']]],
  ['index_2',['index',['../structossa_1_1depth_1_1DepthFrame.html#ad7b3a5c71002bf0bcfab398eb5fb9025',1,'ossa::depth::DepthFrame']]],
  ['inferred_5fconfidence_3',['inferred_confidence',['../structossa_1_1forest_1_1ProposalTarget.html#a0be27b5b657a75bc4b42edc635f49344',1,'ossa::forest::ProposalTarget']]],
  ['input_4',['input',['../structossa_1_1forest_1_1NetworkExamples.html#a9598f71fb0f82de64f41996392a0f58a',1,'ossa::forest::NetworkExamples']]],
  ['input_5fscale_5',['input_scale',['../structossa_1_1forest_1_1Refinement.html#a300643ec20cd2cebe961a9d7b7dccd3e',1,'ossa::forest::Refinement::input_scale()'],['../structossa_1_1recon_1_1RectifiedNetwork.html#a2bc734efa2abc0e242f3d342d2b2cd11',1,'ossa::recon::RectifiedNetwork::input_scale()']]],
  ['instant_6',['instant',['../structossa_1_1recon_1_1Reliability.html#a72370a4068864a16d84b0df34223d6eb',1,'ossa::recon::Reliability']]],
  ['instructions_7',['instructions',['../structossa_1_1forest_1_1ClassifyOptions.html#a416e8bef91fa252850e9bff355b524c6',1,'ossa::forest::ClassifyOptions']]],
  ['inwards_5fm_8',['inwards_m',['../structossa_1_1recon_1_1HidingOptions.html#a4547c0de6630aac13f6caeda83111b58',1,'ossa::recon::HidingOptions']]],
  ['is_5fperson_9',['is_person',['../structossa_1_1recon_1_1LookInput.html#ae2360eeae926b4c001fef4565aa7346c',1,'ossa::recon::LookInput']]]
];
