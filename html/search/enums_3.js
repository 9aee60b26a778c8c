var searchData=
[
  ['joint_0',['Joint',['../namespaceossa_1_1recon.html#a9431ed6d5afbdd47019755a479aa6800',1,'ossa::recon']]]
];
