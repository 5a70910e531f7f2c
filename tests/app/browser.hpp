#pragma once

// A browser without a window and without a network.

#include <cstdlib>
#include <string>

#include "tests/app/program.hpp"

namespace torsion::engine::test {

/// Opens a page and, by `words`, prints what it is once its scripts have run, or takes its picture.
/// @param out  file for what it prints
/// @return its exit code
inline int chromium(const Folder& folder, const std::string& words, const std::string& page,
                    const std::string& out) {
  const std::string command =
      "timeout 300 chromium --headless --no-sandbox --disable-gpu --use-gl=angle "
      "--use-angle=swiftshader --enable-unsafe-swiftshader --host-resolver-rules='MAP * ~NOTFOUND' "
      "--hide-scrollbars --window-size=640,480 --virtual-time-budget=2000 --user-data-dir=" +
      (folder / "profile") + " " + words + " 'file://" + page + "' > " + out + " 2> " +
      (folder / "chromium.log");
  return std::system(command.c_str());  // NOLINT(cert-env33-c,concurrency-mt-unsafe): a browser
}

}  // namespace torsion::engine::test
