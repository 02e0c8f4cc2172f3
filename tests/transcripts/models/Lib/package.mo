package Lib "A package in several files"
  constant Real gain = 2.5;
end Lib;
