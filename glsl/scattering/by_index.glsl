// Profiles by their number, for tables that have a row for each: scattering_profile() looks them up by object.

int profile_count() { return textureSize(scattering_profile_curves, 0).y / 4; }

// All rows of one profile are the same. There are at most 1024 of them; the bound is llvmpipe's, for a buffer gone wrong.
ScatteringProfileRow profile_at(int index) {
    ScatteringProfileRow profile = scattering_profile_default;
    for (uint i = 0u; i < min(scattering_profile_count, 16384u) && profile.index != index; ++i)
        profile = scattering_profile_entries[i].row;
    return profile;
}
