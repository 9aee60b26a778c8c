var searchData=
[
  ['d_5fmin_5fm_0',['d_min_m',['../structossa_1_1recon_1_1ReliabilityOptions.html#acf1d857e8d46f3cc4d765fce9d9cef8f',1,'ossa::recon::ReliabilityOptions']]],
  ['database_1',['database',['../structossa_1_1recon_1_1ReconstructorOptions.html#ab19593dc77d6598972e2e40891581367',1,'ossa::recon::ReconstructorOptions::database()'],['../structossa_1_1tracker_1_1TrackerOptions.html#adaf67766cdf61037f7bd879d85254952',1,'ossa::tracker::TrackerOptions::database()']]],
  ['decay_2',['decay',['../structossa_1_1forest_1_1NetworkOptions.html#aaa7b1e0ad15555036f111d8424eb04d9',1,'ossa::forest::NetworkOptions']]],
  ['depth_3',['depth',['../structossa_1_1forest_1_1TrainOptions.html#a31097655b2e9604102dce892275ebcfa',1,'ossa::forest::TrainOptions::depth()'],['../structossa_1_1recon_1_1ReconstructionInput.html#a2555a87153dbbd94d28057a1d3c43b91',1,'ossa::recon::ReconstructionInput::depth()'],['../structossa_1_1recon_1_1LookInput.html#adfc48c7655baf5a2117710750fb4098a',1,'ossa::recon::LookInput::depth()']]],
  ['depth_5fm_4',['depth_m',['../structossa_1_1depth_1_1RenderedImage.html#a20c4b4466a16b093da4262b8c4c86a9d',1,'ossa::depth::RenderedImage']]],
  ['depth_5fmm_5',['depth_mm',['../structossa_1_1forest_1_1TrainingImage.html#a4482072e2fc1e0232361b75b667b9581',1,'ossa::forest::TrainingImage::depth_mm()'],['../structossa_1_1depth_1_1SensorImage.html#a0ad15b01733db90161901e20b8e352f4',1,'ossa::depth::SensorImage::depth_mm()'],['../structossa_1_1depth_1_1DepthFrame.html#a2a03f4a223829691fe902e16ab4f3690',1,'ossa::depth::DepthFrame::depth_mm()']]],
  ['device_5fwait_6',['device_wait',['../structossa_1_1depth_1_1SourceOptions.html#ac4e021b4af2378fd3f5378eed81acdbe',1,'ossa::depth::SourceOptions']]],
  ['dimensions_7',['dimensions',['../structossa_1_1recon_1_1LocalPcaOptions.html#a1e7d84e66156eb2631dc852a152135c6',1,'ossa::recon::LocalPcaOptions']]],
  ['disparity_5fnoise_5fpx_8',['disparity_noise_px',['../structossa_1_1depth_1_1StructuredLightOptions.html#a49fdd267a9922480c40d8f806eddd22f',1,'ossa::depth::StructuredLightOptions']]],
  ['disparity_5fstep_5fpx_9',['disparity_step_px',['../structossa_1_1depth_1_1StructuredLightOptions.html#a3cd64720e0381271a0370f71b85dd038',1,'ossa::depth::StructuredLightOptions']]],
  ['distance_10',['distance',['../structossa_1_1recon_1_1Neighbour.html#a68d49df7bfe9c6a1666e290318157120',1,'ossa::recon::Neighbour']]],
  ['dodge_11',['dodge',['../structossa_1_1physics_1_1CharacterOptions.html#ac673a0f90fd29b721214494f129d7c78',1,'ossa::physics::CharacterOptions']]],
  ['dropout_12',['dropout',['../structossa_1_1depth_1_1StructuredLightOptions.html#a1365b4580ec79e2a65ae538980e5e5e1',1,'ossa::depth::StructuredLightOptions']]],
  ['dropped_13',['dropped',['../structossa_1_1depth_1_1ReadResult.html#abe2f995afe909522e517436c5e17967c',1,'ossa::depth::ReadResult::dropped()'],['../structossa_1_1forest_1_1NetworkOptions.html#a49211a77f49b3eb240d141ee22fdffa7',1,'ossa::forest::NetworkOptions::dropped()']]]
];
