package Basics "T in °C"
end Basics;
