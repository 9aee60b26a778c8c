var searchData=
[
  ['fakenectdump_0',['FakenectDump',['../classossa_1_1depth_1_1FakenectDump.html',1,'ossa::depth']]],
  ['filteredposture_1',['FilteredPosture',['../structossa_1_1physics_1_1FilteredPosture.html',1,'ossa::physics']]],
  ['flatpiece_2',['FlatPiece',['../structossa_1_1depth_1_1FlatPiece.html',1,'ossa::depth']]],
  ['flatplane_3',['FlatPlane',['../structossa_1_1depth_1_1FlatPlane.html',1,'ossa::depth']]],
  ['flooroptions_4',['FloorOptions',['../structossa_1_1depth_1_1FloorOptions.html',1,'ossa::depth']]],
  ['floorplane_5',['FloorPlane',['../structossa_1_1depth_1_1FloorPlane.html',1,'ossa::depth']]],
  ['floorstate_6',['FloorState',['../structossa_1_1depth_1_1FloorState.html',1,'ossa::depth']]],
  ['folderlock_7',['FolderLock',['../classossa_1_1FolderLock.html',1,'ossa']]],
  ['forestdata_8',['ForestData',['../structossa_1_1forest_1_1ForestData.html',1,'ossa::forest']]],
  ['forestmodel_9',['ForestModel',['../classossa_1_1forest_1_1ForestModel.html',1,'ossa::forest']]],
  ['framesource_10',['FrameSource',['../classossa_1_1depth_1_1FrameSource.html',1,'ossa::depth']]]
];
