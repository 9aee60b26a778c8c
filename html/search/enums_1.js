var searchData=
[
  ['clippededge_0',['ClippedEdge',['../namespaceossa_1_1tracker.html#aef5141cc5171e90f955c1dd62acf3330',1,'ossa::tracker']]]
];
