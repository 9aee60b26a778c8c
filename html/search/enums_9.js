var searchData=
[
  ['weightform_0',['WeightForm',['../namespaceossa_1_1recon.html#adc9283369378329485e84903bf011b34',1,'ossa::recon']]]
];
