var searchData=
[
  ['input_0',['Input',['../classossa_1_1recon_1_1PriorFilter.html#a354bb277b422855226fd29642037108f',1,'ossa::recon::PriorFilter']]],
  ['inputerror_1',['InputError',['../classossa_1_1InputError.html#aebd24084469a7b6a79de68cc8680bd52',1,'ossa::InputError::InputError()'],['../structossa_1_1DiskFull.html#aebd24084469a7b6a79de68cc8680bd52',1,'ossa::DiskFull::InputError()']]],
  ['is_5flive_2',['is_live',['../classossa_1_1depth_1_1FrameSource.html#aef396bf365fe63d1527532d99a891b46',1,'ossa::depth::FrameSource']]],
  ['isforgotten_3',['IsForgotten',['../namespaceossa_1_1depth.html#a58b702ced156a320a736f2e61f2fe56c',1,'ossa::depth']]],
  ['isintheair_4',['IsInTheAir',['../namespaceossa_1_1recon.html#a3cfd9d5fa07ab3e18ed5a3b381c186e5',1,'ossa::recon']]],
  ['isone_5',['IsOne',['../classossa_1_1recon_1_1PostureDatabase.html#a2d0cb37001a3cac6c79891665f761872',1,'ossa::recon::PostureDatabase::IsOne()'],['../structossa_1_1recon_1_1LearnedModels.html#aca1929ee5a8e26c83957ea47c419222f',1,'ossa::recon::LearnedModels::IsOne()'],['../structossa_1_1recon_1_1PosturePrior.html#a50bc1ec2c72b02d9170d5de855a82ead',1,'ossa::recon::PosturePrior::IsOne()'],['../structossa_1_1recon_1_1CloseLook.html#ac46eca4a3ef60567cbf26f0b2838e028',1,'ossa::recon::CloseLook::IsOne()']]],
  ['isrecording_6',['IsRecording',['../namespaceossa_1_1depth.html#aad136cb5c5b9d1121f51ddbb195378b3',1,'ossa::depth']]],
  ['isreferenceposture_7',['IsReferencePosture',['../namespaceossa_1_1recon.html#a5303e45c2fd2478a890050fcc7354f70',1,'ossa::recon']]],
  ['issane_8',['IsSane',['../namespaceossa_1_1depth.html#acceafac59a28cbe37597ca5dcd693841',1,'ossa::depth']]],
  ['isseatedjoint_9',['IsSeatedJoint',['../namespaceossa_1_1tracker.html#a55c65c9c8855c4d1b85ad18d5936a632',1,'ossa::tracker']]],
  ['isshippedfile_10',['IsShippedFile',['../namespaceossa_1_1tracker.html#aeec8ca4fbdcfe7e483fbfde0b52c93fc',1,'ossa::tracker']]],
  ['isstep_11',['IsStep',['../classossa_1_1recon_1_1LinearFilter.html#aa039dc7f7694b292a14bf023510acb12',1,'ossa::recon::LinearFilter']]]
];
