package oldLoads
end oldLoads;
