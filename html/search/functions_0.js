var searchData=
[
  ['absoluteof_0',['AbsoluteOf',['../namespaceossa_1_1recon.html#af167f2e87bb6232c2d7d8e4236bece5c',1,'ossa::recon']]],
  ['add_1',['Add',['../classossa_1_1recon_1_1GaussianProcess.html#a1849429ee995efebce6fd09c42b08b3d',1,'ossa::recon::GaussianProcess']]],
  ['addcharacter_2',['AddCharacter',['../classossa_1_1physics_1_1World.html#af2b2a199f35eaba1351c16158ec29e80',1,'ossa::physics::World']]],
  ['addmesh_3',['AddMesh',['../classossa_1_1depth_1_1Renderer.html#aa457443e634a2f638ef52caa2e4edc46',1,'ossa::depth::Renderer']]],
  ['addpairs_4',['AddPairs',['../namespaceossa_1_1recon.html#abc3b096f64f9f4c0a5221009094764ab',1,'ossa::recon']]],
  ['adjoining_5',['Adjoining',['../namespaceossa_1_1depth.html#a847fc936193ac8a2c48c864ccc2f1ae8',1,'ossa::depth']]],
  ['append_6',['Append',['../namespaceossa_1_1depth.html#a5217c69f7a879faa0cb4da8619113b96',1,'ossa::depth']]],
  ['area_7',['Area',['../structossa_1_1depth_1_1PointGrid.html#aeee01600ce7ae65fa3ddad2eb8551e61',1,'ossa::depth::PointGrid']]],
  ['around_8',['Around',['../classossa_1_1recon_1_1SurfaceSampler.html#abdee5d0b136eec35ffe53f6c9394ade4',1,'ossa::recon::SurfaceSampler']]],
  ['arrivedarea_5fm2_9',['ArrivedArea_m2',['../namespaceossa_1_1depth.html#a5838bb49087df1e830002a6f5678bccb',1,'ossa::depth']]],
  ['arrivedpersonsized_10',['ArrivedPersonSized',['../namespaceossa_1_1depth.html#aff9139d5a927b04d0f0377cf12d61070',1,'ossa::depth']]],
  ['arrivedsince_11',['ArrivedSince',['../namespaceossa_1_1depth.html#a89ce392237829fbfa7a94653627272c8',1,'ossa::depth']]],
  ['authoredactions_12',['AuthoredActions',['../namespaceossa_1_1recon.html#a064b5da6f9beacfdc9fcd9b856026bdf',1,'ossa::recon']]],
  ['authoredclips_13',['AuthoredClips',['../namespaceossa_1_1recon.html#a721f2e65abdd31a7bcd1385c634ec6d2',1,'ossa::recon']]],
  ['averagekinectdepthtable_14',['AverageKinectDepthTable',['../namespaceossa_1_1depth.html#af84babde849199930896d99b75ab0ef9',1,'ossa::depth']]]
];
