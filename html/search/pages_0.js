var searchData=
[
  ['architecture_0',['Architecture',['../index.html',1,'']]]
];
