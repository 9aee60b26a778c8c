var searchData=
[
  ['databaseoptions_0',['DatabaseOptions',['../structossa_1_1recon_1_1DatabaseOptions.html',1,'ossa::recon']]],
  ['depthframe_1',['DepthFrame',['../structossa_1_1depth_1_1DepthFrame.html',1,'ossa::depth']]],
  ['depthview_2',['DepthView',['../structossa_1_1depth_1_1DepthView.html',1,'ossa::depth']]],
  ['diskfull_3',['DiskFull',['../structossa_1_1DiskFull.html',1,'ossa']]]
];
