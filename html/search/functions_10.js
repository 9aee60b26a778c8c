var searchData=
[
  ['quantile_0',['Quantile',['../classossa_1_1tracker_1_1TimeHistogram.html#a73600a33414934f0fe5a8ba6fde19705',1,'ossa::tracker::TimeHistogram']]]
];
