var searchData=
[
  ['marks_0',['Marks',['../namespaceossa_1_1depth.html#a62e92866a1657c5573c03d796a278267',1,'ossa::depth']]],
  ['measuredbody_1',['MeasuredBody',['../namespaceossa_1_1depth.html#a39dfe56d1fe8d4e0de326031b811877c',1,'ossa::depth']]]
];
