var searchData=
[
  ['steps_0',['Steps',['../classossa_1_1recon_1_1LinearFilter.html#a1b8940f18fe9b717a019e3a18360d0bf',1,'ossa::recon::LinearFilter']]]
];
