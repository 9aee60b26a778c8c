var searchData=
[
  ['measure_0',['Measure',['../namespaceossa_1_1depth.html#a61a1a8135d3359483d1d86343f652b20',1,'ossa::depth']]]
];
