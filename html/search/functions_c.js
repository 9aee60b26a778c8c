var searchData=
[
  ['makebox_0',['MakeBox',['../namespaceossa_1_1depth.html#ad233fd2f8b64b81a6daeb4bf5dfd38e4',1,'ossa::depth']]],
  ['makecapsule_1',['MakeCapsule',['../namespaceossa_1_1depth.html#a3004edf18430f42c2eb13e77aa255aa5',1,'ossa::depth']]],
  ['makechair_2',['MakeChair',['../namespaceossa_1_1depth.html#a82176d242ae99a8094a15b1d770aa5aa',1,'ossa::depth']]],
  ['makereconstructor_3',['MakeReconstructor',['../namespaceossa_1_1recon.html#a96b2f38303c5a9102b893b4d511fd10c',1,'ossa::recon']]],
  ['makeroom_4',['MakeRoom',['../namespaceossa_1_1depth.html#a0884ebcfea8cd360e90f54ac5f4ff8e9',1,'ossa::depth']]],
  ['makesofa_5',['MakeSofa',['../namespaceossa_1_1depth.html#a85de7ca19755b20e9bf922543c374402',1,'ossa::depth']]],
  ['maketable_6',['MakeTable',['../namespaceossa_1_1depth.html#aaf38f3e5c885143a3e96a8e6604311f3',1,'ossa::depth']]],
  ['mayreturnas_7',['MayReturnAs',['../namespaceossa_1_1depth.html#a8a0ef82c113b87242e078944a181f454',1,'ossa::depth']]],
  ['measurebones_8',['MeasureBones',['../namespaceossa_1_1recon.html#a6dedaf6928aba2125f1005dfa07ce624',1,'ossa::recon']]],
  ['measuredbones_9',['MeasuredBones',['../namespaceossa_1_1recon.html#acf3fb00aeb1759ea3171ac8595ecdf2e',1,'ossa::recon']]],
  ['metresfrommillimetres_10',['MetresFromMillimetres',['../namespaceossa_1_1depth.html#aa3ada6b762401b348448e06c7f1d2f16',1,'ossa::depth']]],
  ['mirrored_11',['Mirrored',['../structossa_1_1recon_1_1ProposedPerson.html#a52250ebddfe8dfac0921996ba171893f',1,'ossa::recon::ProposedPerson::Mirrored()'],['../namespaceossa_1_1recon.html#a45b149a651fbbc07a8517785bb5f47d7',1,'ossa::recon::Mirrored(const PosturePair &amp;pair)'],['../namespaceossa_1_1recon.html#a47dcb2040afb06af6937629935428edb',1,'ossa::recon::Mirrored(const Posture &amp;normalised)']]],
  ['mostlyof_12',['MostlyOf',['../namespaceossa_1_1depth.html#a2b34350ef5e2e372eac21a6ef5783232',1,'ossa::depth']]],
  ['moved_13',['Moved',['../namespaceossa_1_1depth.html#a11158f5ed6d92b0a33d91872b094d5a5',1,'ossa::depth']]],
  ['movedto_14',['MovedTo',['../structossa_1_1recon_1_1LookInput.html#a976564c46f0c98eb05ee9516f1575bad',1,'ossa::recon::LookInput']]]
];
