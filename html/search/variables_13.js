var searchData=
[
  ['u_0',['u',['../structossa_1_1forest_1_1Node.html#a1343031300df428c4f976c2150352e79',1,'ossa::forest::Node']]],
  ['unplug_5fafter_1',['unplug_after',['../structossa_1_1depth_1_1VirtualDeviceOptions.html#ad307ba385b0cbfa429aad833bae1083c',1,'ossa::depth::VirtualDeviceOptions']]],
  ['unplugs_2',['unplugs',['../structossa_1_1depth_1_1VirtualDeviceOptions.html#a9ac344bf8b809836554f91f4d139b2b7',1,'ossa::depth::VirtualDeviceOptions']]],
  ['up_3',['up',['../structossa_1_1depth_1_1PointGrid.html#a035902ec16872470b93f1e83f041ae0d',1,'ossa::depth::PointGrid']]],
  ['use_5fbehaviour_4',['use_behaviour',['../structossa_1_1recon_1_1ReliabilityOptions.html#af229a6d535b686b128fde2d73d22e0a0',1,'ossa::recon::ReliabilityOptions']]],
  ['use_5fdepth_5',['use_depth',['../structossa_1_1recon_1_1ReliabilityOptions.html#a103637e1563db7a8039006add5bf547b',1,'ossa::recon::ReliabilityOptions']]],
  ['use_5fkinematics_6',['use_kinematics',['../structossa_1_1recon_1_1ReliabilityOptions.html#aa4dce4ecfbaf91052b832a94b2eaf1bc',1,'ossa::recon::ReliabilityOptions']]],
  ['use_5freliability_7',['use_reliability',['../structossa_1_1recon_1_1LocalPcaOptions.html#ad9ad9cafa0640edad287b7965072e193',1,'ossa::recon::LocalPcaOptions']]],
  ['use_5fspeed_8',['use_speed',['../structossa_1_1recon_1_1ReliabilityOptions.html#afc5a956a0ff595a66fbfa373fae7d63a',1,'ossa::recon::ReliabilityOptions']]],
  ['use_5fstate_9',['use_state',['../structossa_1_1recon_1_1ReliabilityOptions.html#adcbaa32a889424f0a13e53ad7a7deeef',1,'ossa::recon::ReliabilityOptions']]],
  ['users_10',['users',['../structossa_1_1depth_1_1SceneState.html#af692b2605fc915c932c072a9a2008d6b',1,'ossa::depth::SceneState::users()'],['../structossa_1_1tracker_1_1BodyFrame.html#ab74f7a1c4da9cd7d40b7ea29507cd06d',1,'ossa::tracker::BodyFrame::users()']]],
  ['usual_5fspeed_11',['usual_speed',['../structossa_1_1recon_1_1ReliabilityOptions.html#ac5cfde604da32d87a3ee280c577c014e',1,'ossa::recon::ReliabilityOptions']]]
];
