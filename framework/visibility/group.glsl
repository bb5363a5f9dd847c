#version 450 core
layout(local_size_x = 64) in;  // as bands.h has it
