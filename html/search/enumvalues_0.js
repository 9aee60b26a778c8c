var searchData=
[
  ['kdisconnected_0',['kDisconnected',['../namespaceossa_1_1depth.html#a9d1b294a85de22ac911710a6545a33fcaf469e2a5b05d423dd49764004270f117',1,'ossa::depth']]],
  ['kend_1',['kEnd',['../namespaceossa_1_1depth.html#a9d1b294a85de22ac911710a6545a33fca374bf9ba57a441a600d65b212cf9d13c',1,'ossa::depth']]],
  ['kmaxjoint_2',['kMaxJoint',['../namespaceossa_1_1recon.html#ad4a6b593ac6d7d725ce381bcb2c80253a37af9098084f33b33e9fcee9d5b3f9c8',1,'ossa::recon']]],
  ['kpositiononly_3',['kPositionOnly',['../namespaceossa_1_1tracker.html#aff138f45cd9d3fafdd1f0c0a7000000aaa3cad6375c1e6bdd5243a20d8cabc101',1,'ossa::tracker']]],
  ['kseated_4',['kSeated',['../namespaceossa_1_1tracker.html#a46b80c384d1e35e7a89358154812c846aaad21112b510604581018b6713db2955',1,'ossa::tracker']]],
  ['kstanding_5',['kStanding',['../namespaceossa_1_1tracker.html#a46b80c384d1e35e7a89358154812c846a6869a28396fa304469adc53251290be9',1,'ossa::tracker']]],
  ['ksumsquared_6',['kSumSquared',['../namespaceossa_1_1recon.html#ad4a6b593ac6d7d725ce381bcb2c80253ac9293ac6815cb9563f4c5269b0c480ca',1,'ossa::recon']]],
  ['ktimeout_7',['kTimeout',['../namespaceossa_1_1depth.html#a9d1b294a85de22ac911710a6545a33fca7f27861ff1d3f550c6aa77150d7edabd',1,'ossa::depth']]],
  ['ktracked_8',['kTracked',['../namespaceossa_1_1tracker.html#aff138f45cd9d3fafdd1f0c0a7000000aa68394d8f1fe37acd6d36415ea43a8860',1,'ossa::tracker']]]
];
