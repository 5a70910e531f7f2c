// usage: has_red_banner FILE: whether a picture of the window has the red banner on it.

#include <cstdio>

#include "render/image_io.hpp"
#include "tests/app/window_pictures.hpp"

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "usage: has_red_banner FILE\n");
    return 2;
  }
  const torsion::engine::Result<torsion::engine::Image> image = torsion::engine::read_png(words[1]);
  if (!image) {
    std::fprintf(stderr, "%s\n", image.error().text.c_str());
    return 2;
  }
  return torsion::engine::test::has_red_banner(image.value()) ? 0 : 1;
}
