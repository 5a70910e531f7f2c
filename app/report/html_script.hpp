#pragma once

namespace torsion::engine {

/// Fills the frame of a case's run when it is opened, and empties it when it is closed: a browser
/// has no more than some 16 of them at once.
inline constexpr const char* kReportScript = R"js(
"use strict";
for (const details of document.querySelectorAll("details.run")) {
  details.addEventListener("toggle", () => {
    const before = details.querySelector("iframe");
    if (before) {
      before.remove();
    }
    if (!details.open) {
      return;
    }
    const section = details.closest("section");
    const parts = JSON.parse(document.getElementById("run-parts").textContent);
    const values = { TITLE: section.querySelector("h2").innerHTML,
                     CAPTION: "with the model patch on a body without end, however it was measured",
                     THREE: parts.three, ORBIT: parts.orbit, VIEW: parts.view,
                     DATA: document.getElementById("run-" + section.id).textContent };
    const frame = document.createElement("iframe");
    frame.title = section.querySelector("h2").textContent;
    frame.srcdoc = parts.page.replace(/%([A-Z]+)%/g, (all, name) => name in values ? values[name] : all);
    details.append(frame);
  });
}
)js";

}  // namespace torsion::engine
