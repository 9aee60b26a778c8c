var searchData=
[
  ['image_0',['Image',['../structossa_1_1depth_1_1Image.html',1,'ossa::depth']]],
  ['image_3c_20float_20_3e_1',['Image&lt; float &gt;',['../structossa_1_1depth_1_1Image.html',1,'ossa::depth']]],
  ['image_3c_20int16_5ft_20_3e_2',['Image&lt; int16_t &gt;',['../structossa_1_1depth_1_1Image.html',1,'ossa::depth']]],
  ['image_3c_20int32_5ft_20_3e_3',['Image&lt; int32_t &gt;',['../structossa_1_1depth_1_1Image.html',1,'ossa::depth']]],
  ['image_3c_20uint16_5ft_20_3e_4',['Image&lt; uint16_t &gt;',['../structossa_1_1depth_1_1Image.html',1,'ossa::depth']]],
  ['image_3c_20uint8_5ft_20_3e_5',['Image&lt; uint8_t &gt;',['../structossa_1_1depth_1_1Image.html',1,'ossa::depth']]],
  ['imagesize_6',['ImageSize',['../structossa_1_1depth_1_1ImageSize.html',1,'ossa::depth']]],
  ['inputerror_7',['InputError',['../classossa_1_1InputError.html',1,'ossa']]]
];
