var searchData=
[
  ['readstatus_0',['ReadStatus',['../namespaceossa_1_1depth.html#a9d1b294a85de22ac911710a6545a33fc',1,'ossa::depth']]]
];
