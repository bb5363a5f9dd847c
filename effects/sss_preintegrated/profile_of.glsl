// Profiles by their number, for the tables.

int profile_count() { return textureSize(scattering_profile_curves, 0).y / 4; }

ScatteringProfileRow profile_of(int index) {
    ScatteringProfileRow row = scattering_profile_default;
    for (uint i = 0u; i < scattering_profile_count; ++i)
        if (scattering_profile_entries[i].row.index == index) row = scattering_profile_entries[i].row;
    return row;
}
