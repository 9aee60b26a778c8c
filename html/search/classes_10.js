var searchData=
[
  ['threadlimit_0',['ThreadLimit',['../classossa_1_1forest_1_1ThreadLimit.html',1,'ossa::forest']]],
  ['timehistogram_1',['TimeHistogram',['../classossa_1_1tracker_1_1TimeHistogram.html',1,'ossa::tracker']]],
  ['trackedposture_2',['TrackedPosture',['../structossa_1_1recon_1_1TrackedPosture.html',1,'ossa::recon']]],
  ['tracker_3',['Tracker',['../classossa_1_1tracker_1_1Tracker.html',1,'ossa::tracker']]],
  ['trackeroptions_4',['TrackerOptions',['../structossa_1_1tracker_1_1TrackerOptions.html',1,'ossa::tracker']]],
  ['trainingimage_5',['TrainingImage',['../structossa_1_1forest_1_1TrainingImage.html',1,'ossa::forest']]],
  ['trainingsource_6',['TrainingSource',['../classossa_1_1forest_1_1TrainingSource.html',1,'ossa::forest']]],
  ['trainingvocabulary_7',['TrainingVocabulary',['../structossa_1_1forest_1_1TrainingVocabulary.html',1,'ossa::forest']]],
  ['traininterrupted_8',['TrainInterrupted',['../structossa_1_1forest_1_1TrainInterrupted.html',1,'ossa::forest']]],
  ['trainoptions_9',['TrainOptions',['../structossa_1_1forest_1_1TrainOptions.html',1,'ossa::forest']]],
  ['trainprogress_10',['TrainProgress',['../structossa_1_1forest_1_1TrainProgress.html',1,'ossa::forest']]],
  ['trainsummary_11',['TrainSummary',['../structossa_1_1forest_1_1TrainSummary.html',1,'ossa::forest']]],
  ['tree_12',['Tree',['../structossa_1_1forest_1_1Tree.html',1,'ossa::forest']]],
  ['trianglemesh_13',['TriangleMesh',['../structossa_1_1depth_1_1TriangleMesh.html',1,'ossa::depth']]]
];
