// Torsion from C# by P/Invoke, as Unity or any other .NET program would call it.
//
//   mcs own_loop.cs && mono own_loop.exe ball_on_cube.gltf

using System;
using System.Runtime.InteropServices;

[StructLayout(LayoutKind.Sequential)]
struct Pose {
  [MarshalAs(UnmanagedType.ByValArray, SizeConst = 3)] public double[] position;     // m
  [MarshalAs(UnmanagedType.ByValArray, SizeConst = 4)] public double[] orientation;  // w, x, y, z
}

[StructLayout(LayoutKind.Sequential)]
struct Wrench {
  [MarshalAs(UnmanagedType.ByValArray, SizeConst = 3)] public double[] force;   // N
  [MarshalAs(UnmanagedType.ByValArray, SizeConst = 3)] public double[] torque;  // N m
}

static class Torsion {
  const string Library = "libtorsion.so.1";
  [DllImport(Library)] public static extern uint torsion_interface_version();
  [DllImport(Library)] static extern IntPtr torsion_last_error();
  [DllImport(Library)] public static extern IntPtr torsion_load_scene(string path);
  [DllImport(Library)] public static extern int torsion_free_scene(IntPtr scene);
  [DllImport(Library)] public static extern int torsion_scene_duration(IntPtr scene, out double seconds);
  [DllImport(Library)] public static extern int torsion_animated_pose(IntPtr scene, UIntPtr tool, double time, out Pose pose);
  [DllImport(Library)] public static extern int torsion_set_number(IntPtr scene, string body, string key, double value);
  [DllImport(Library)] public static extern IntPtr torsion_build(IntPtr scene, IntPtr options);
  [DllImport(Library)] public static extern int torsion_free_model(IntPtr model);
  [DllImport(Library)] public static extern IntPtr torsion_new_simulation(IntPtr model);
  [DllImport(Library)] public static extern int torsion_free_simulation(IntPtr simulation);
  [DllImport(Library)] public static extern int torsion_step(IntPtr simulation, ref Pose pose, UIntPtr count);
  [DllImport(Library)] public static extern int torsion_time(IntPtr simulation, out double seconds);
  [DllImport(Library)] public static extern int torsion_tool_wrench(IntPtr simulation, UIntPtr tool, out Wrench wrench);

  /// The handle, or an exception with what the library says.
  public static IntPtr Made(IntPtr handle) {
    if (handle == IntPtr.Zero) throw new Exception(Marshal.PtrToStringAnsi(torsion_last_error()));
    return handle;
  }
  /// The result, or an exception where it is below 0.
  public static int Done(int result) {
    if (result < 0) throw new Exception(Marshal.PtrToStringAnsi(torsion_last_error()));
    return result;
  }
}

static class OwnLoop {
  static int Main(string[] arguments) {
    if (Torsion.torsion_interface_version() != 1) return 1;
    try {
      Torsion.Made(Torsion.torsion_load_scene("nowhere.gltf"));
      return 1;
    } catch (Exception error) {
      Console.WriteLine("as it should be: " + error.Message.Trim());
    }
    IntPtr scene = Torsion.Made(Torsion.torsion_load_scene(arguments[0]));
    Torsion.Done(Torsion.torsion_set_number(scene, "cube", "youngs_modulus", 2e5));
    IntPtr model = Torsion.Made(Torsion.torsion_build(scene, IntPtr.Zero));
    IntPtr simulation = Torsion.Made(Torsion.torsion_new_simulation(model));
    double duration, time, largest = 0.0;
    Torsion.Done(Torsion.torsion_scene_duration(scene, out duration));
    for (Torsion.Done(Torsion.torsion_time(simulation, out time)); time < duration;
         Torsion.Done(Torsion.torsion_time(simulation, out time))) {
      Pose pose;
      Wrench wrench;
      Torsion.Done(Torsion.torsion_animated_pose(scene, UIntPtr.Zero, time, out pose));
      int faults = Torsion.Done(Torsion.torsion_step(simulation, ref pose, new UIntPtr(1)));
      if (faults != 0) return 1;
      Torsion.Done(Torsion.torsion_tool_wrench(simulation, UIntPtr.Zero, out wrench));
      largest = Math.Max(largest, Math.Abs(wrench.torque[1]));
    }
    Console.WriteLine("largest torque about the vertical: {0:F3} mN m", 1e3 * largest);
    Torsion.Done(Torsion.torsion_free_simulation(simulation));
    Torsion.Done(Torsion.torsion_free_model(model));
    Torsion.Done(Torsion.torsion_free_scene(scene));
    return largest > 0.0 ? 0 : 1;
  }
}
