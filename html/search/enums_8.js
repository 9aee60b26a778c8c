var searchData=
[
  ['trackingmode_0',['TrackingMode',['../namespaceossa_1_1tracker.html#a46b80c384d1e35e7a89358154812c846',1,'ossa::tracker']]],
  ['trackingstate_1',['TrackingState',['../namespaceossa_1_1recon.html#a924f904f974ec671cdc01b24f6708a75',1,'ossa::recon']]]
];
