// A number of an object's own, 1 to 2 in steps of 1/1024, of which a mean tells whether it is of that object alone; 0 for what
// does not scatter. Knuth's multiplicative hash: neighbouring ids have different ones.
float mark_of(uint key) { return key == 0u ? 0.0 : 1.0 + float((key * 2654435761u) >> 22u) / 1024.0; }
