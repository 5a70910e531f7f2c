// The window as a video: of the scene, in all its pixels. The panel comes back at the end, or with
// H while it is filmed; the window's title says that it is.

#include <cmath>

#include <fmt/format.h>

#include "app/view/viewer.hpp"

namespace torsion::engine {
namespace {

constexpr double kPicturesASecond = 25.0;

}  // namespace

void Viewer::begin_or_end_film() {
  if (film_.writer) {
    end_film("");
    return;
  }
  const WindowInput& input = window_->input();
  film_ = Film{};
  film_.name = file_name(".mp4");
  film_.width = input.width;
  film_.height = input.height;
  Result<VideoWriter> writer =
      VideoWriter::create(film_.name, input.width, input.height, kPicturesASecond);
  if (!writer) {
    say(writer.error().text);
    return;
  }
  film_.writer = std::move(writer).value();
  film_.panels = state_.show_panels;
  state_.show_panels = false;
  window_->set_title("Filming " + film_.name + " (V ends it)");
  film_.begun = now();
}

/// Whether the picture about to be drawn is one of the video's.
bool Viewer::film_due() const {
  return film_.writer &&
         now() >= film_.begun + static_cast<double>(film_.pictures) / kPicturesASecond;
}

/// Adds the picture just shown, more than once where the window is slower than the video.
void Viewer::add_to_film() {
  const Result<Image> image = renderer_->screenshot();
  if (!image) {
    end_film(image.error().text);
    return;
  }
  if (image.value().width != film_.width || image.value().height != film_.height) {
    end_film("the window has another size");
    return;
  }
  const auto due = static_cast<std::uint64_t>((now() - film_.begun) * kPicturesASecond) + 1;
  while (film_.pictures < due) {
    const Result<Done> added = film_.writer->add(image.value());
    if (!added) {
      film_.writer.reset();
      state_.show_panels = film_.panels;
      window_->set_title(window_title(options_.scene));
      say(added.error().text);
      return;
    }
    film_.pictures += 1;
  }
}

/// @param why  it ends though nobody asked for that; empty: somebody did
void Viewer::end_film(const std::string& why) {
  const Result<Done> finished = film_.writer->finish();
  film_.writer.reset();
  state_.show_panels = film_.panels;
  window_->set_title(window_title(options_.scene));
  say(!finished ? finished.error().text
                : fmt::format("{}: {:.1f} s{}", whole_path(film_.name),
                              static_cast<double>(film_.pictures) / kPicturesASecond,
                              why.empty() ? "" : "; ended, because " + why));
}

}  // namespace torsion::engine
