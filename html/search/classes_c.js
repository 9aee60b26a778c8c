var searchData=
[
  ['objectoptions_0',['ObjectOptions',['../structossa_1_1physics_1_1ObjectOptions.html',1,'ossa::physics']]],
  ['objectstate_1',['ObjectState',['../structossa_1_1physics_1_1ObjectState.html',1,'ossa::physics']]],
  ['onirecorder_2',['OniRecorder',['../classossa_1_1depth_1_1OniRecorder.html',1,'ossa::depth']]],
  ['ossa_5fbody_3',['ossa_body',['../structossa__body.html',1,'']]],
  ['ossa_5fcamera_4',['ossa_camera',['../structossa__camera.html',1,'']]],
  ['ossa_5fframe_5',['ossa_frame',['../structossa__frame.html',1,'']]],
  ['ossa_5fjoint_6',['ossa_joint',['../structossa__joint.html',1,'']]],
  ['ossa_5foptions_7',['ossa_options',['../structossa__options.html',1,'']]],
  ['ossa_5fsmooth_5fparameters_8',['ossa_smooth_parameters',['../structossa__smooth__parameters.html',1,'']]]
];
