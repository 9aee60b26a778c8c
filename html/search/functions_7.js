var searchData=
[
  ['halfof_0',['HalfOf',['../namespaceossa_1_1recon.html#a3697bccace4c086ae167d6a2cd818d6d',1,'ossa::recon']]],
  ['hang_1',['Hang',['../classossa_1_1physics_1_1World.html#a50c0549a3f1a30b2aa0b77bf8bffa55b',1,'ossa::physics::World']]],
  ['hasmoved_2',['HasMoved',['../namespaceossa_1_1depth.html#a8af0aecacc309e92a1b1dfa38db41031',1,'ossa::depth']]],
  ['hasplace_3',['HasPlace',['../namespaceossa_1_1recon.html#a91f6a741b9ee0b4d2ff61a4c597a1ebe',1,'ossa::recon']]],
  ['haspulls_4',['HasPulls',['../classossa_1_1recon_1_1LinearFilter.html#aa202714866dd8e36cdada0c5cce259c4',1,'ossa::recon::LinearFilter']]],
  ['headingof_5',['HeadingOf',['../namespaceossa_1_1recon.html#a7b0ea531d85ffde759fe13d2a042176e',1,'ossa::recon']]],
  ['headseed_6',['HeadSeed',['../namespaceossa_1_1depth.html#abf5663aa20e51506a9c99d1afeaae937',1,'ossa::depth']]],
  ['hiddenbetween_7',['HiddenBetween',['../namespaceossa_1_1depth.html#a7c3f9a3778377c109cd44cc102ff19b8',1,'ossa::depth']]],
  ['hiddenplace_8',['HiddenPlace',['../namespaceossa_1_1recon.html#aab7d1055e0d782a23eb849eb68b3a334',1,'ossa::recon']]],
  ['hidespartof_9',['HidesPartOf',['../namespaceossa_1_1depth.html#a0c9205915c5c8f361004c6815249905d',1,'ossa::depth']]],
  ['hideunworn_10',['HideUnworn',['../classossa_1_1recon_1_1Wardrobe.html#a1f6f23d46a55dc085e1a45346dc27b77',1,'ossa::recon::Wardrobe']]],
  ['hierarchicalof_11',['HierarchicalOf',['../namespaceossa_1_1recon.html#a38d6ea402259f2caf9d0bf78c72cdc35',1,'ossa::recon']]],
  ['hold_12',['Hold',['../classossa_1_1physics_1_1World.html#a0b0fd6001a16788891f3b24b8cb76a38',1,'ossa::physics::World']]]
];
