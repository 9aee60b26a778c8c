var searchData=
[
  ['databasefilter_0',['DatabaseFilter',['../namespaceossa_1_1recon.html#ad4a6b593ac6d7d725ce381bcb2c80253',1,'ossa::recon']]]
];
