var searchData=
[
  ['edge_5fthreshold_5fm_0',['edge_threshold_m',['../classossa_1_1recon_1_1PostureDatabase.html#a93e5571802c1d970cab7a08a2b538c83',1,'ossa::recon::PostureDatabase']]],
  ['empty_1',['empty',['../structossa_1_1recon_1_1RectifiedNetwork.html#aab718b06d6be356be5aba2e679305e51',1,'ossa::recon::RectifiedNetwork']]],
  ['encodecolourpng_2',['EncodeColourPng',['../namespaceossa_1_1depth.html#a3c8c89ba485f2b63f796c8db5f0f3330',1,'ossa::depth']]],
  ['estimate_3',['Estimate',['../classossa_1_1recon_1_1LinearFilter.html#a24fdf4b4bc132692cd3404fc86bbfb59',1,'ossa::recon::LinearFilter']]],
  ['expectend_4',['ExpectEnd',['../classossa_1_1PayloadReader.html#a122806bab4230d2d38ab6536d7a89af8',1,'ossa::PayloadReader']]]
];
