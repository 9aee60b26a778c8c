var searchData=
[
  ['nearestpostures_0',['NearestPostures',['../namespaceossa_1_1recon.html#af5c2740a3d6479cb0ec671ee09278265',1,'ossa::recon']]],
  ['needsdatabase_1',['NeedsDatabase',['../namespaceossa_1_1recon.html#a1e79c26848f80b4d6b62c78134ab3bda',1,'ossa::recon']]],
  ['needslearned_2',['NeedsLearned',['../namespaceossa_1_1recon.html#a5bf5aa8430ab8c1821351ff7efe61d80',1,'ossa::recon']]],
  ['negativeloglikelihood_3',['NegativeLogLikelihood',['../namespaceossa_1_1recon.html#a93c344a30f7ffd611e57cf24a6f07414',1,'ossa::recon']]],
  ['neighbours_4',['neighbours',['../classossa_1_1recon_1_1PostureDatabase.html#a0ae4747a0b1a8964655aca98ec72d13a',1,'ossa::recon::PostureDatabase']]],
  ['networkrunner_5',['NetworkRunner',['../classossa_1_1recon_1_1NetworkRunner.html#adc9e3c351c6df3fd2052ea1325cfc580',1,'ossa::recon::NetworkRunner']]],
  ['next_6',['Next',['../classossa_1_1recon_1_1SkeletonJsonlReader.html#a54cbdeef4516ce4ae573e972df65e55a',1,'ossa::recon::SkeletonJsonlReader']]],
  ['noise_7',['noise',['../classossa_1_1recon_1_1LocalMixture.html#ab13650900557ab51a4d5d9fc957fc854',1,'ossa::recon::LocalMixture']]],
  ['normalised_8',['Normalised',['../structossa_1_1recon_1_1RectifiedNetwork.html#aefb6e1011c968db0f53567b0b457f072',1,'ossa::recon::RectifiedNetwork::Normalised()'],['../namespaceossa_1_1recon.html#a1d2fde49f59d1c50e282b841f3903b8b',1,'ossa::recon::Normalised(const Posture &amp;in_camera, const Placement &amp;camera_from_normalised)']]],
  ['normalisedruns_9',['NormalisedRuns',['../namespaceossa_1_1recon.html#a611a85393f90a953a6430aa3a8807d42',1,'ossa::recon']]]
];
