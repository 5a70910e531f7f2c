// Rows that every invocation reads come as texels: the same bytes, but a processor's driver fetches texels for all
// lanes at once, and goes through storage lane by lane (Mesa's gallivm). False where the device takes fewer texels than
// there are rows; then they come from storage.
layout(constant_id = 0) const bool kTexels = true;
