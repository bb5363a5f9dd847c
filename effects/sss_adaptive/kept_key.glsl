// An object's key as a float, exact: never 0 for what scatters; keys that differ by 2^24 are taken for one object.
float key_of(uint key) { return key == 0u ? 0.0 : float(key & 0xFFFFFFu) + 1.0; }
