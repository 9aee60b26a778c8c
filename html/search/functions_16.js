var searchData=
[
  ['weighteddistance_0',['WeightedDistance',['../namespaceossa_1_1recon.html#ab7a29e508c5c298187df1ea6132da20e',1,'ossa::recon']]],
  ['with_1',['With',['../classossa_1_1recon_1_1PostureDatabase.html#a6663a0826b7c52153f654fcbbeedcf06',1,'ossa::recon::PostureDatabase']]],
  ['withbonelengths_2',['WithBoneLengths',['../namespaceossa_1_1recon.html#aa368792b09a5917594efbb3a8735bfdc',1,'ossa::recon']]],
  ['withoutheading_3',['WithoutHeading',['../namespaceossa_1_1recon.html#a8a66dc27567a59ea346b2ea1d54ccf5e',1,'ossa::recon']]],
  ['write_4',['Write',['../classossa_1_1depth_1_1OniRecorder.html#a4ac8d6066d0e91ea96c4e4759e3cda7f',1,'ossa::depth::OniRecorder']]],
  ['writebvhofskeleton_5',['WriteBvhOfSkeleton',['../namespaceossa_1_1recon.html#a669859b76e1ce721ee2f8a8ed8f3fdff',1,'ossa::recon']]],
  ['writedepthpng_6',['WriteDepthPng',['../namespaceossa_1_1depth.html#ae85e82d46a9856da7ff422179b3e6760',1,'ossa::depth']]],
  ['writepicture_7',['WritePicture',['../namespaceossa_1_1tracker.html#a24cc8584d0397f9c61627824bfa5ab0c',1,'ossa::tracker']]],
  ['writeskeletons_8',['WriteSkeletons',['../namespaceossa_1_1recon.html#a1552b97b464625a55dae88aa9463e9fe',1,'ossa::recon']]]
];
