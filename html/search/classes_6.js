var searchData=
[
  ['headblob_0',['HeadBlob',['../structossa_1_1depth_1_1HeadBlob.html',1,'ossa::depth']]],
  ['hidingoptions_1',['HidingOptions',['../structossa_1_1recon_1_1HidingOptions.html',1,'ossa::recon']]]
];
