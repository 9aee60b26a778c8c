var searchData=
[
  ['gaussianprocess_0',['GaussianProcess',['../classossa_1_1recon_1_1GaussianProcess.html#a9406a0892b539dbe8a09fd1b4c218f09',1,'ossa::recon::GaussianProcess']]],
  ['getnetwork_1',['GetNetwork',['../namespaceossa_1_1recon.html#adf57160cdabdd5939febae781cefc388',1,'ossa::recon']]],
  ['getunits_2',['GetUnits',['../namespaceossa_1_1recon.html#acbfcec9406c25591039844dd20748b95',1,'ossa::recon']]]
];
