var searchData=
[
  ['vertex_5flayer_0',['vertex_layer',['../classossa_1_1recon_1_1BodyModel.html#a56c80be5bb0fb03fbcce72d5795ea507',1,'ossa::recon::BodyModel']]],
  ['vertex_5fpart_1',['vertex_part',['../classossa_1_1recon_1_1BodyModel.html#a149501a3cf8e524787c9f169a8ae472a',1,'ossa::recon::BodyModel']]]
];
