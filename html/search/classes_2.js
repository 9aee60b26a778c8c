var searchData=
[
  ['camera_0',['Camera',['../structossa_1_1depth_1_1Camera.html',1,'ossa::depth']]],
  ['candidate_1',['Candidate',['../structossa_1_1depth_1_1Candidate.html',1,'ossa::depth']]],
  ['candidatesigns_2',['CandidateSigns',['../structossa_1_1tracker_1_1CandidateSigns.html',1,'ossa::tracker']]],
  ['characterfilter_3',['CharacterFilter',['../classossa_1_1physics_1_1CharacterFilter.html',1,'ossa::physics']]],
  ['characterfilteroptions_4',['CharacterFilterOptions',['../structossa_1_1physics_1_1CharacterFilterOptions.html',1,'ossa::physics']]],
  ['characteroptions_5',['CharacterOptions',['../structossa_1_1physics_1_1CharacterOptions.html',1,'ossa::physics']]],
  ['characterstate_6',['CharacterState',['../structossa_1_1physics_1_1CharacterState.html',1,'ossa::physics']]],
  ['classification_7',['Classification',['../structossa_1_1forest_1_1Classification.html',1,'ossa::forest']]],
  ['classifyoptions_8',['ClassifyOptions',['../structossa_1_1forest_1_1ClassifyOptions.html',1,'ossa::forest']]],
  ['closelook_9',['CloseLook',['../structossa_1_1recon_1_1CloseLook.html',1,'ossa::recon']]],
  ['clothing_10',['Clothing',['../structossa_1_1recon_1_1Clothing.html',1,'ossa::recon']]],
  ['contactsummary_11',['ContactSummary',['../structossa_1_1physics_1_1ContactSummary.html',1,'ossa::physics']]],
  ['containerformat_12',['ContainerFormat',['../structossa_1_1ContainerFormat.html',1,'ossa']]],
  ['controlgains_13',['ControlGains',['../structossa_1_1physics_1_1ControlGains.html',1,'ossa::physics']]]
];
