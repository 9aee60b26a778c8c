var searchData=
[
  ['gaussianprediction_0',['GaussianPrediction',['../structossa_1_1recon_1_1GaussianPrediction.html',1,'ossa::recon']]],
  ['gaussianprocess_1',['GaussianProcess',['../classossa_1_1recon_1_1GaussianProcess.html',1,'ossa::recon']]],
  ['gaussianprocessoptions_2',['GaussianProcessOptions',['../structossa_1_1recon_1_1GaussianProcessOptions.html',1,'ossa::recon']]],
  ['gaussianprocessparameters_3',['GaussianProcessParameters',['../structossa_1_1recon_1_1GaussianProcessParameters.html',1,'ossa::recon']]]
];
