var searchData=
[
  ['arrangement_0',['Arrangement',['../structossa_1_1forest_1_1Arrangement.html',1,'ossa::forest']]],
  ['atomicfile_1',['AtomicFile',['../classossa_1_1AtomicFile.html',1,'ossa']]],
  ['authoredoptions_2',['AuthoredOptions',['../structossa_1_1recon_1_1AuthoredOptions.html',1,'ossa::recon']]]
];
