var searchData=
[
  ['learn_0',['Learn',['../structossa_1_1recon_1_1LearnedModels.html#a03a59a072d9921fe90aa181aa3eca337',1,'ossa::recon::LearnedModels::Learn()'],['../classossa_1_1recon_1_1LocalMixture.html#a99876352fac26a24babbcd29e22680d2',1,'ossa::recon::LocalMixture::Learn()'],['../structossa_1_1recon_1_1PosturePrior.html#ad2a76407703ba3ebf9515d1172db60f7',1,'ossa::recon::PosturePrior::Learn()']]],
  ['learnbackground_1',['LearnBackground',['../namespaceossa_1_1depth.html#a1e43631926430d6987ac5e56d571affd',1,'ossa::depth']]],
  ['learnedsideof_2',['LearnedSideOf',['../namespaceossa_1_1recon.html#a2e91e2142351292cc874e82d0095d0d0',1,'ossa::recon']]],
  ['learnparameters_3',['LearnParameters',['../namespaceossa_1_1recon.html#ad9ec0b546c9840aee17d375dc81c8c44',1,'ossa::recon']]],
  ['letgo_4',['LetGo',['../classossa_1_1physics_1_1World.html#aca8c7c0b95b1c1e18842615bdcbcc42c',1,'ossa::physics::World']]],
  ['load_5',['Load',['../classossa_1_1recon_1_1BodyModel.html#a4c58ceb10600e709357a50322cebe4cd',1,'ossa::recon::BodyModel::Load()'],['../classossa_1_1recon_1_1PostureDatabase.html#a907d657e4a0cf04c75aad18b65af0a33',1,'ossa::recon::PostureDatabase::Load()'],['../structossa_1_1recon_1_1PosturePrior.html#a02b81e6330ffdfb6e4bd096f92630a0f',1,'ossa::recon::PosturePrior::Load()']]],
  ['loadmocap_6',['LoadMocap',['../namespaceossa_1_1recon.html#a444127649442f3391bd86b8369f8fc31',1,'ossa::recon']]],
  ['localmixture_7',['LocalMixture',['../classossa_1_1recon_1_1LocalMixture.html#aab62eebb7512a3657ef57bff1bf49811',1,'ossa::recon::LocalMixture']]],
  ['loglikelihoodratio_8',['LogLikelihoodRatio',['../namespaceossa_1_1depth.html#a11ebb0c76036f57478a6137a7926962a',1,'ossa::depth']]],
  ['look_9',['Look',['../classossa_1_1recon_1_1Looker.html#a4aa8fe1f7854e8b6d5074232b3b39ff1',1,'ossa::recon::Looker']]],
  ['looksample_10',['LookSample',['../classossa_1_1recon_1_1LookSample.html#ac5691abdb1ac311f4875e5a5835bed27',1,'ossa::recon::LookSample']]]
];
