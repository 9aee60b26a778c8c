var searchData=
[
  ['yaw_5frad_0',['yaw_rad',['../structossa_1_1recon_1_1Placement.html#aca87677a125a9127982533623ba9dfb3',1,'ossa::recon::Placement']]]
];
