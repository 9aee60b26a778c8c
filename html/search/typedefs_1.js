var searchData=
[
  ['glance_0',['Glance',['../namespaceossa_1_1recon.html#a9f3ada9a534663720ab94959cdc2239c',1,'ossa::recon']]]
];
