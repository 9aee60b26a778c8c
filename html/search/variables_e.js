var searchData=
[
  ['object_5fdepth_5fm_0',['object_depth_m',['../structossa_1_1physics_1_1ContactSummary.html#a36dbadc6d13f57ec25045e668933a42c',1,'ossa::physics::ContactSummary']]],
  ['observed_1',['observed',['../structossa_1_1recon_1_1ReconstructionInput.html#aada61a9a8f9903d03814b80a2ad93329',1,'ossa::recon::ReconstructionInput::observed()'],['../structossa_1_1recon_1_1PosturePair.html#a5300d01c92727c9ee99cefda83206a5c',1,'ossa::recon::PosturePair::observed()']]],
  ['of_2',['of',['../structossa_1_1recon_1_1WeightBytes.html#a57ea8757a13806d571e3cd6a31fff68b',1,'ossa::recon::WeightBytes']]],
  ['of_5fposture_3',['of_posture',['../structossa_1_1recon_1_1BestConstants.html#a6c9467e56996a8070c9dfaee3e78a921',1,'ossa::recon::BestConstants']]],
  ['offset_4',['offset',['../structossa_1_1recon_1_1BvhJoint.html#a5488eefac23be20feb6c657d6a9b67d3',1,'ossa::recon::BvhJoint']]],
  ['offsets_5',['offsets',['../structossa_1_1forest_1_1TrainOptions.html#a22bf730b717d6fb8cb9cd9af657a78f6',1,'ossa::forest::TrainOptions']]],
  ['orientation_6',['orientation',['../structossa_1_1recon_1_1ReconstructedPosture.html#a3351a33a83c57ec96b6cb5bb5a70ed0f',1,'ossa::recon::ReconstructedPosture::orientation()'],['../structossa_1_1recon_1_1JointRecord.html#a12c542ce10269ad41bda556260c1a417',1,'ossa::recon::JointRecord::orientation()'],['../structossa_1_1physics_1_1FilteredPosture.html#a83c2022c0fa7d2b8701e17cdf0d2a4b9',1,'ossa::physics::FilteredPosture::orientation()'],['../structossa_1_1physics_1_1CharacterState.html#aedd76ea72d95dd16a0494ded0503120d',1,'ossa::physics::CharacterState::orientation()']]],
  ['orientations_7',['orientations',['../structossa_1_1recon_1_1PostureClip.html#acda6d4e5df593af89ff5de4b63c4f4e6',1,'ossa::recon::PostureClip']]],
  ['origin_8',['origin',['../structossa_1_1depth_1_1Candidate.html#a1306ef9a83586b8a28454b7141272777',1,'ossa::depth::Candidate']]],
  ['other_5fway_9',['other_way',['../structossa_1_1depth_1_1ReidentifyOptions.html#ad75295a854237b82b40927232abc228b',1,'ossa::depth::ReidentifyOptions']]],
  ['outwards_10',['outwards',['../structossa_1_1recon_1_1BestConstants.html#a4b4dfc494b571e99f38c30a11d6d2b6c',1,'ossa::recon::BestConstants']]]
];
