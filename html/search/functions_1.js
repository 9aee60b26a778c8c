var searchData=
[
  ['backproject_0',['BackProject',['../namespaceossa_1_1depth.html#ae93f4207b1e0797101ecca202d7eb6a8',1,'ossa::depth']]],
  ['base_5fm_1',['base_m',['../classossa_1_1recon_1_1BodyModel.html#a063a0a4ae75f30faaab1b9cd1682b74f',1,'ossa::recon::BodyModel']]],
  ['behind_5fmm_2',['behind_mm',['../classossa_1_1recon_1_1LookSample.html#a0984101ad6653b7a1e60eb737f4a1094',1,'ossa::recon::LookSample']]],
  ['bodyfolder_3',['BodyFolder',['../namespaceossa_1_1recon.html#a0fb8ffdd791d92510b74b3de68a67da0',1,'ossa::recon']]],
  ['bodyscaleof_4',['BodyScaleOf',['../namespaceossa_1_1recon.html#a17096cb9503088a9e92a3394d6c5656e',1,'ossa::recon']]],
  ['bones_5',['Bones',['../classossa_1_1recon_1_1Reconstructor.html#ad67ebeefa7d0b554895b17257fd5c803',1,'ossa::recon::Reconstructor']]],
  ['bones_5fm_6',['Bones_m',['../classossa_1_1recon_1_1PriorFilter.html#ab2db8d19fd27ede8d0d719b1e2b29230',1,'ossa::recon::PriorFilter']]],
  ['bonesof_7',['BonesOf',['../namespaceossa_1_1recon.html#a2412061cee470f97f3ccb0a943a27254',1,'ossa::recon']]],
  ['budgetedsamples_8',['BudgetedSamples',['../namespaceossa_1_1recon.html#ad0df345260abc9ceff6d06752f0bcac9',1,'ossa::recon']]],
  ['build_9',['Build',['../classossa_1_1recon_1_1PostureDatabase.html#a34dddd6448c75ba78a61ee2f7cbef1eb',1,'ossa::recon::PostureDatabase']]],
  ['butterworthsequence_10',['ButterworthSequence',['../namespaceossa_1_1recon.html#a76204b5cc31120f023ccbd7981a4f6c1',1,'ossa::recon']]],
  ['bvhofskeleton_11',['BvhOfSkeleton',['../namespaceossa_1_1recon.html#afda6b73857ddb4e598bb7dc39dfa3300',1,'ossa::recon']]],
  ['bytesof_12',['BytesOf',['../namespaceossa_1_1recon.html#a8ce3494a29b8b354f4a47aedb06bc0c7',1,'ossa::recon']]]
];
