var searchData=
[
  ['backgroundoptions_0',['BackgroundOptions',['../structossa_1_1depth_1_1BackgroundOptions.html',1,'ossa::depth']]],
  ['backgroundstate_1',['BackgroundState',['../structossa_1_1depth_1_1BackgroundState.html',1,'ossa::depth']]],
  ['bestconstants_2',['BestConstants',['../structossa_1_1recon_1_1BestConstants.html',1,'ossa::recon']]],
  ['bestoptions_3',['BestOptions',['../structossa_1_1recon_1_1BestOptions.html',1,'ossa::recon']]],
  ['body_4',['Body',['../structossa_1_1tracker_1_1Body.html',1,'ossa::tracker']]],
  ['bodyframe_5',['BodyFrame',['../structossa_1_1tracker_1_1BodyFrame.html',1,'ossa::tracker']]],
  ['bodymeasures_6',['BodyMeasures',['../structossa_1_1depth_1_1BodyMeasures.html',1,'ossa::depth']]],
  ['bodymodel_7',['BodyModel',['../classossa_1_1recon_1_1BodyModel.html',1,'ossa::recon']]],
  ['bodyrecord_8',['BodyRecord',['../structossa_1_1recon_1_1BodyRecord.html',1,'ossa::recon']]],
  ['bodyshape_9',['BodyShape',['../structossa_1_1recon_1_1BodyShape.html',1,'ossa::recon']]],
  ['bone_10',['Bone',['../structossa_1_1depth_1_1Bone.html',1,'ossa::depth']]],
  ['bvhexportoptions_11',['BvhExportOptions',['../structossa_1_1recon_1_1BvhExportOptions.html',1,'ossa::recon']]],
  ['bvhfile_12',['BvhFile',['../structossa_1_1recon_1_1BvhFile.html',1,'ossa::recon']]],
  ['bvhframepose_13',['BvhFramePose',['../structossa_1_1recon_1_1BvhFramePose.html',1,'ossa::recon']]],
  ['bvhjoint_14',['BvhJoint',['../structossa_1_1recon_1_1BvhJoint.html',1,'ossa::recon']]]
];
