#pragma once

namespace torsion::engine {

/// Lets the X server take pictures in small pieces, where they go through its socket.
///
/// An X server without DRI3 (Xvfb, many servers of remote desktops) gets a software driver's
/// pictures through the connection, 3.7 MB for 1280 x 720. It copies for as long as more arrives,
/// and with the drawing thread on the other core that is up to the whole picture, 1 to 3 ms within
/// one call of the kernel. A kernel without preemption lets no other thread run on that core
/// meanwhile, SCHED_FIFO or not: physics is late. With less on its way at once such a call ends
/// before more has arrived.
///
/// @pre GLFW is initialised. Where the display is not X, or not on this machine, nothing changes.
void send_pictures_in_pieces();

}  // namespace torsion::engine
