var searchData=
[
  ['uncertainty_5fm_0',['Uncertainty_m',['../classossa_1_1recon_1_1PriorFilter.html#a20ad99d7aa4af9e03e1d7b1640a351c6',1,'ossa::recon::PriorFilter']]],
  ['update_1',['Update',['../classossa_1_1recon_1_1LocalMixture.html#ab3588dce6d37ecccbe00c85e2421ac33',1,'ossa::recon::LocalMixture']]],
  ['updatevertices_2',['UpdateVertices',['../classossa_1_1depth_1_1Renderer.html#adb0bd34bc1932353000b46e9dfd7f7c8',1,'ossa::depth::Renderer']]],
  ['userimage_3',['UserImage',['../namespaceossa_1_1depth.html#aa8d41a185e06a348878a7d7a30934b29',1,'ossa::depth']]],
  ['usualsmoothing_4',['UsualSmoothing',['../namespaceossa_1_1tracker.html#a51494ab1155296355b53274c50b75cf9',1,'ossa::tracker']]]
];
