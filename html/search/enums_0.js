var searchData=
[
  ['bodylayer_0',['BodyLayer',['../namespaceossa_1_1recon.html#a418ef83b644dd9344cb63f1bb58b2920',1,'ossa::recon']]],
  ['bodystate_1',['BodyState',['../namespaceossa_1_1tracker.html#aff138f45cd9d3fafdd1f0c0a7000000a',1,'ossa::tracker']]],
  ['bvhchannel_2',['BvhChannel',['../namespaceossa_1_1recon.html#abaa5a957b7e263339da9a437a3aca4b4',1,'ossa::recon']]]
];
