var searchData=
[
  ['neighbour_0',['Neighbour',['../structossa_1_1recon_1_1Neighbour.html',1,'ossa::recon']]],
  ['networkexamples_1',['NetworkExamples',['../structossa_1_1forest_1_1NetworkExamples.html',1,'ossa::forest']]],
  ['networklayer_2',['NetworkLayer',['../structossa_1_1forest_1_1NetworkLayer.html',1,'ossa::forest']]],
  ['networkoptions_3',['NetworkOptions',['../structossa_1_1forest_1_1NetworkOptions.html',1,'ossa::forest']]],
  ['networkrunner_4',['NetworkRunner',['../classossa_1_1recon_1_1NetworkRunner.html',1,'ossa::recon']]],
  ['node_5',['Node',['../structossa_1_1forest_1_1Node.html',1,'ossa::forest']]]
];
