#version 450 core
#include <pass>
