var searchData=
[
  ['of_0',['Of',['../classossa_1_1recon_1_1NetworkRunner.html#ab4d432b3b3787610096e90eac02b650f',1,'ossa::recon::NetworkRunner::Of()'],['../structossa_1_1recon_1_1ProposedPerson.html#ad7b44443c5c1fdf5bc49d3a315504e69',1,'ossa::recon::ProposedPerson::Of()'],['../structossa_1_1recon_1_1LookDescription.html#a2f5dd6bde06331638060b5a34b1075c9',1,'ossa::recon::LookDescription::Of()']]],
  ['offsets_1',['Offsets',['../classossa_1_1recon_1_1PoseCorrection.html#aff913bd3492eb04307dbc436b20162be',1,'ossa::recon::PoseCorrection']]],
  ['ofoneperson_2',['OfOnePerson',['../namespaceossa_1_1recon.html#af58e33dade66f9642fd30401f1cda4b8',1,'ossa::recon']]],
  ['oneabove_3',['OneAbove',['../namespaceossa_1_1depth.html#a0f0a6cf9c5d228432c21bc8fd041fce7',1,'ossa::depth']]],
  ['onfloor_4',['OnFloor',['../structossa_1_1depth_1_1PointGrid.html#a7dc590254b0beacb85b147cd72ce1ef0',1,'ossa::depth::PointGrid']]],
  ['onirecorder_5',['OniRecorder',['../classossa_1_1depth_1_1OniRecorder.html#ac79c67694927be8c0e7023d8b4bd880e',1,'ossa::depth::OniRecorder']]],
  ['onorunder_6',['OnOrUnder',['../namespaceossa_1_1depth.html#adf50f1a57f484b691cce9ee8299dc33a',1,'ossa::depth']]],
  ['openniruntimefolder_7',['OpenNiRuntimeFolder',['../namespaceossa_1_1depth.html#a43cfdc0f6e61dfa31845b1983a3764de',1,'ossa::depth']]],
  ['opensource_8',['OpenSource',['../namespaceossa_1_1depth.html#a21634f390256f9346e640fe66e405996',1,'ossa::depth']]],
  ['orientations_9',['orientations',['../classossa_1_1recon_1_1PostureDatabase.html#a238bc148937c7cc5bc2579ef58590ad7',1,'ossa::recon::PostureDatabase']]],
  ['orientationsof_10',['OrientationsOf',['../namespaceossa_1_1recon.html#afc7188848427842462e283867cab9cb6',1,'ossa::recon']]],
  ['overlaps_11',['Overlaps',['../namespaceossa_1_1depth.html#a8486aec6f2fd7924b0c11b6a089a66a2',1,'ossa::depth']]]
];
