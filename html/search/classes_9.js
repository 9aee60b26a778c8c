var searchData=
[
  ['layer_0',['Layer',['../structossa_1_1recon_1_1RectifiedNetwork_1_1Layer.html',1,'ossa::recon::RectifiedNetwork']]],
  ['learnedmodels_1',['LearnedModels',['../structossa_1_1recon_1_1LearnedModels.html',1,'ossa::recon']]],
  ['learnoptions_2',['LearnOptions',['../structossa_1_1recon_1_1LearnOptions.html',1,'ossa::recon']]],
  ['linearfilter_3',['LinearFilter',['../classossa_1_1recon_1_1LinearFilter.html',1,'ossa::recon']]],
  ['linearfilteroptions_4',['LinearFilterOptions',['../structossa_1_1recon_1_1LinearFilterOptions.html',1,'ossa::recon']]],
  ['localmixture_5',['LocalMixture',['../classossa_1_1recon_1_1LocalMixture.html',1,'ossa::recon']]],
  ['localmixtureoptions_6',['LocalMixtureOptions',['../structossa_1_1recon_1_1LocalMixtureOptions.html',1,'ossa::recon']]],
  ['localpcaoptions_7',['LocalPcaOptions',['../structossa_1_1recon_1_1LocalPcaOptions.html',1,'ossa::recon']]],
  ['logistic_8',['Logistic',['../structossa_1_1forest_1_1Logistic.html',1,'ossa::forest']]],
  ['logistic_3c_205_20_3e_9',['Logistic&lt; 5 &gt;',['../structossa_1_1forest_1_1Logistic.html',1,'ossa::forest']]],
  ['logistic_3c_208_20_3e_10',['Logistic&lt; 8 &gt;',['../structossa_1_1forest_1_1Logistic.html',1,'ossa::forest']]],
  ['lookdescription_11',['LookDescription',['../structossa_1_1recon_1_1LookDescription.html',1,'ossa::recon']]],
  ['looked_12',['Looked',['../structossa_1_1recon_1_1Looked.html',1,'ossa::recon']]],
  ['looker_13',['Looker',['../classossa_1_1recon_1_1Looker.html',1,'ossa::recon']]],
  ['lookinput_14',['LookInput',['../structossa_1_1recon_1_1LookInput.html',1,'ossa::recon']]],
  ['looksample_15',['LookSample',['../classossa_1_1recon_1_1LookSample.html',1,'ossa::recon']]]
];
