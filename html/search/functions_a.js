var searchData=
[
  ['keepnear_0',['KeepNear',['../namespaceossa_1_1depth.html#ae8f693f58220a6aaf1a5251363641c58',1,'ossa::depth']]],
  ['keepsbones_1',['KeepsBones',['../namespaceossa_1_1recon.html#ab39912936e5c56a780aae1169d410996',1,'ossa::recon']]],
  ['kernelmatrix_2',['KernelMatrix',['../namespaceossa_1_1recon.html#a3c022f9eaffc1bad5894395aa6b5a6d5',1,'ossa::recon']]],
  ['kinectv1camera_3',['KinectV1Camera',['../namespaceossa_1_1depth.html#a859afe007fd192b766e0dd8baf65f4bf',1,'ossa::depth']]],
  ['kmeans_4',['KMeans',['../namespaceossa_1_1recon.html#aba3960424997bc042c72d978f9147657',1,'ossa::recon']]]
];
