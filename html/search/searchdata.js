var indexSectionsWithContent =
{
  0: "abcdefghijklmnopqrstuvwyz",
  1: "abcdfghijlmnoprstuvw",
  2: "o",
  3: "abcdefghijklmnopqrstuvw",
  4: "abcdefghijklmnoprstuvwyz",
  5: "bgjms",
  6: "bcdjmoprtw",
  7: "k",
  8: "a"
};

var indexSectionNames =
{
  0: "all",
  1: "classes",
  2: "namespaces",
  3: "functions",
  4: "variables",
  5: "typedefs",
  6: "enums",
  7: "enumvalues",
  8: "pages"
};

var indexSectionLabels =
{
  0: "All",
  1: "Classes",
  2: "Namespaces",
  3: "Functions",
  4: "Variables",
  5: "Typedefs",
  6: "Enumerations",
  7: "Enumerator",
  8: "Pages"
};

