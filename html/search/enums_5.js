var searchData=
[
  ['output_0',['Output',['../classossa_1_1recon_1_1LinearFilter.html#a33e6e8eec49b4888dee95f68fa1a75f8',1,'ossa::recon::LinearFilter']]]
];
