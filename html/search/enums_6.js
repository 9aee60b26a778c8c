var searchData=
[
  ['posturekind_0',['PostureKind',['../namespaceossa_1_1tracker.html#a50dfeb571c6c0af65b004738e0a0e975',1,'ossa::tracker']]]
];
