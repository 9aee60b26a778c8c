var searchData=
[
  ['absolute_5forientation_0',['absolute_orientation',['../structossa_1_1tracker_1_1Body.html#a7c826c5dc1a3d10bc84fee5fde84569e',1,'ossa::tracker::Body']]],
  ['absorbed_1',['absorbed',['../structossa_1_1depth_1_1Candidate.html#a78e03ae980ebdf7778661baa7be1b62f',1,'ossa::depth::Candidate']]],
  ['acceleration_2',['acceleration',['../structossa_1_1recon_1_1BestConstants.html#a0670c210c2cb0bd3ea6f1cb6b79af454',1,'ossa::recon::BestConstants']]],
  ['accelerations_3',['accelerations',['../structossa_1_1recon_1_1LinearFilterOptions.html#a958b21a1a1f38603ca8a4f83008187ea',1,'ossa::recon::LinearFilterOptions']]],
  ['african_4',['african',['../structossa_1_1recon_1_1BodyShape.html#ad1a1bfbe28bc77e678a7c24fdfe23815',1,'ossa::recon::BodyShape']]],
  ['age_5',['age',['../structossa_1_1recon_1_1BodyShape.html#a497763eec03cd93943f434d8279bc582',1,'ossa::recon::BodyShape']]],
  ['alone_6',['alone',['../structossa_1_1depth_1_1Candidate.html#a7341edc704d1a498face9e4027824d79',1,'ossa::depth::Candidate']]],
  ['amc_5fhz_7',['amc_hz',['../structossa_1_1recon_1_1MocapOptions.html#a0039a59d5ff2181f1c2796909ec743cb',1,'ossa::recon::MocapOptions']]],
  ['apart_8',['apart',['../structossa_1_1forest_1_1ProposalTarget.html#a20aefb3dfb9048da3956248737c87a5a',1,'ossa::forest::ProposalTarget']]],
  ['area_5fm2_9',['area_m2',['../structossa_1_1depth_1_1FlatPiece.html#a7213da0dc260a0517e0cecc8832b3a71',1,'ossa::depth::FlatPiece::area_m2()'],['../structossa_1_1depth_1_1Region.html#a35a0c10714a959b299300e747d5d6762',1,'ossa::depth::Region::area_m2()']]],
  ['arrangements_10',['arrangements',['../structossa_1_1forest_1_1ForestData.html#aafa3dee0d3ee604cabfa3dc563f4d026',1,'ossa::forest::ForestData']]],
  ['arrived_5fm2_11',['arrived_m2',['../structossa_1_1depth_1_1Candidate.html#aa1a8259e0534b26ad304834f64eb8517',1,'ossa::depth::Candidate']]],
  ['arrived_5fshare_12',['arrived_share',['../structossa_1_1depth_1_1UserTrack.html#a502bc9ef087191654afbea9c3fd307b9',1,'ossa::depth::UserTrack::arrived_share()'],['../structossa_1_1depth_1_1Candidate.html#a4e9cb0d0d3511425bdb5d1da1551f1fc',1,'ossa::depth::Candidate::arrived_share()']]],
  ['at_5fzero_13',['at_zero',['../structossa_1_1depth_1_1FlatPlane.html#a143db2c9699a0e61c7ec01a9859f4f49',1,'ossa::depth::FlatPlane']]],
  ['axial_5finertia_5fkgm2_14',['axial_inertia_kgm2',['../structossa_1_1physics_1_1Segment.html#af195b04c9fe9c1e0a59a2db933776717',1,'ossa::physics::Segment']]]
];
