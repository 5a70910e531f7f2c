// Torsion's gateway in C#, for Unity and others: docs/gateway.md. One file, no library. In Unity add it to the project, make
// a Gateway once, and call Exchange from a thread of your own at the device's rate, not from Update().
//
//   mcs TorsionGateway.cs && mono TorsionGateway.exe [PORT [HOST SECRET_FILE]]   plays a hand of numbers, as torsion_gateway.py does
//
// Torsion's axes are right-handed, +y up, +z towards the user; Unity's are left-handed, +z away: FromUnity and ToUnity.
using System;
using System.Diagnostics;
using System.IO;
using System.Net;
using System.Net.Sockets;
using System.Security.Cryptography;
using System.Text;
using System.Threading;

namespace Torsion {

[Flags]
public enum Axes { None = 0, Translation = 1, Rotation = 2, Turn = 4 }

public enum State { Waiting, Rising, Live, Falling, Silent, Refused, Checking, Off }

/// What the device is, as far as stability asks: N, m, kg, s, rad. 0: not known, and Torsion is cautious.
public struct Traits {
  public double Damping, TurnDamping, Mass, Inertia, EncoderStep, EncoderTurnStep, Period, Delay;
  public double LargestForce, LargestTorque, LargestStiffness, LargestTurnStiffness;
}

public struct Answer {
  public State State;
  public uint Faults;
  public double Time;
  public double[] Force, Torque;  // 3: N, N m, to display on the hand; zero where nothing came
  public double[] ToolPosition;   // 3: m
  public double[] ToolRotation;   // 4: x, y, z, w
}

public sealed class Gateway : IDisposable {
  const uint Magic = 0x47524F54;
  const int SampleSize = 240, AnswerSize = 136, ChallengeSize = 32, HeadSize = 16, NonceSize = 16, TagSize = 16;
  const double Patience = 5e-3;  // s: then there is no force any more
  readonly Socket socket;
  readonly uint session = (uint)Guid.NewGuid().GetHashCode();
  readonly byte[] sample = new byte[NonceSize + SampleSize + TagSize];  // a packet stands behind the nonce of its tag
  readonly byte[] came = new byte[512];
  readonly Stopwatch clock = Stopwatch.StartNew();
  readonly HMACSHA256 keyed;  // null: Torsion is on this machine and has no secret
  uint sequence;

  public Axes Sensed = Axes.Translation | Axes.Rotation;
  public Axes Actuated = Axes.Translation | Axes.Rotation;
  public Traits Traits = new Traits { Period = 1e-3 };
  public double RoundTrip { get; private set; }  // s: from a sample to its answer, in the mean

  /// host: in numbers, of another machine only with a secret. secretFile: a copy of what Torsion was given as
  /// --gateway-secret.
  public Gateway(int port = 7747, string host = "127.0.0.1", string secretFile = null) {
    if (!BitConverter.IsLittleEndian) {
      throw new PlatformNotSupportedException("packets have the least significant byte first");
    }
    if (secretFile != null) { keyed = new HMACSHA256(Encoding.UTF8.GetBytes(File.ReadAllText(secretFile).Trim())); }
    var address = IPAddress.Parse(host);
    socket = new Socket(address.AddressFamily, SocketType.Dgram, ProtocolType.Udp);
    socket.Connect(new IPEndPoint(address, port));
    socket.ReceiveTimeout = (int)(1e3 * Patience);
  }

  public void Dispose() { socket.Close(); }

  /// Tells where the handle is: m, from the middle of its workspace; rotation x, y, z, w. An answer without force, and
  /// Silent, where none came within 5 ms.
  public Answer Exchange(double[] position, double[] rotation, uint buttons = 0) {
    ++sequence;
    var asked = clock.Elapsed.TotalSeconds;
    Write(asked, position, rotation, buttons);
    try {
      Send();
      while (clock.Elapsed.TotalSeconds < asked + Patience) {
        var size = Receive();
        var reader = new BinaryReader(new MemoryStream(came, 0, Math.Max(size, 0)));
        if (size < HeadSize || reader.ReadUInt32() != Magic || reader.ReadUInt16() != 1) { continue; }
        var kind = reader.ReadUInt16();
        if (reader.ReadUInt32() != session || reader.ReadUInt32() != sequence) { continue; }  // of an older sample
        var trip = clock.Elapsed.TotalSeconds - asked;
        RoundTrip += (RoundTrip > 0 ? 0.01 : 1.0) * (trip - RoundTrip);
        if (kind == 2 && size == AnswerSize) {
          return new Answer { State = (State)reader.ReadUInt32(), Faults = reader.ReadUInt32(), Time = reader.ReadDouble(),
                              Force = Numbers(reader, 3), Torque = Numbers(reader, 3), ToolPosition = Numbers(reader, 3),
                              ToolRotation = Numbers(reader, 4) };
        }
        if (kind == 3 && keyed != null) {  // a challenge: once more, over its number
          Array.Copy(came, HeadSize, sample, 0, NonceSize);
          Write(asked, position, rotation, buttons);
          Send();
        }
      }
    } catch (SocketException) {  // nobody is there, or nothing came in time
    }
    Array.Clear(sample, 0, NonceSize);  // Torsion may have drawn another: it says so again
    return new Answer { State = State.Silent, Force = new double[3], Torque = new double[3], ToolPosition = new double[3],
                        ToolRotation = new double[] { 0, 0, 0, 1 } };
  }

  void Write(double asked, double[] position, double[] rotation, uint buttons) {
    var writer = new BinaryWriter(new MemoryStream(sample, NonceSize, SampleSize));
    writer.Write(Magic);
    writer.Write((ushort)1);
    writer.Write((ushort)1);
    writer.Write(session);
    writer.Write(sequence);
    writer.Write(asked);
    foreach (var number in position) { writer.Write(number); }
    foreach (var number in rotation) { writer.Write(number); }
    for (int i = 0; i < 6; ++i) { writer.Write(0.0); }  // speeds: not known
    writer.Write(buttons);
    writer.Write((uint)Sensed);
    writer.Write((uint)Actuated);
    writer.Write(0u);
    foreach (var trait in new[] { Traits.Damping, Traits.TurnDamping, Traits.Mass, Traits.Inertia, Traits.EncoderStep,
                                  Traits.EncoderTurnStep, Traits.Period, Traits.Delay + RoundTrip, Traits.LargestForce,
                                  Traits.LargestTorque, Traits.LargestStiffness, Traits.LargestTurnStiffness }) {
      writer.Write(trait);
    }
  }

  void Send() {
    if (keyed != null) {
      Array.Copy(keyed.ComputeHash(sample, 0, NonceSize + SampleSize), 0, sample, NonceSize + SampleSize, TagSize);
    }
    socket.Send(sample, NonceSize, SampleSize + (keyed != null ? TagSize : 0), SocketFlags.None);
  }

  /// The size of the next packet without its tag; -1 of one that is not Torsion's.
  int Receive() {
    var size = socket.Receive(came);
    if (keyed == null) { return size; }
    size -= TagSize;
    if (size != AnswerSize && size != ChallengeSize) { return -1; }
    var tagged = new byte[NonceSize + size];
    var ofChallenge = size == ChallengeSize;
    Array.Copy(ofChallenge ? came : sample, ofChallenge ? HeadSize : 0, tagged, 0, NonceSize);
    Array.Copy(came, 0, tagged, NonceSize, size);
    var tag = keyed.ComputeHash(tagged);
    int wrong = 0;
    for (int i = 0; i < TagSize; ++i) { wrong |= tag[i] ^ came[size + i]; }
    return wrong == 0 ? size : -1;
  }

  static double[] Numbers(BinaryReader reader, int count) {
    var numbers = new double[count];
    for (int i = 0; i < count; ++i) { numbers[i] = reader.ReadDouble(); }
    return numbers;
  }

  /// Unity's place or force to Torsion's, and back.
  public static double[] FromUnity(double x, double y, double z) { return new[] { x, y, -z }; }
  public static double[] ToUnity(double[] v) { return new[] { v[0], v[1], -v[2] }; }

  /// Unity's rotation x, y, z, w to Torsion's, and back: the mirrored z turns the senses about x and y.
  public static double[] FromUnity(double x, double y, double z, double w) { return new[] { -x, -y, z, w }; }
}

static class Program {
  static double Share(double value) { return Math.Min(Math.Max(value, 0.0), 1.0); }

  static void Main(string[] words) {
    var port = words.Length > 0 ? int.Parse(words[0]) : 7747;
    using (var gateway = words.Length == 3 ? new Gateway(port, words[1], words[2]) : new Gateway(port)) {
      gateway.Traits = new Traits { Damping = 1.0, TurnDamping = 1e-3, Mass = 0.1, Period = 1e-3, LargestForce = 8.0,
                                    LargestTorque = 0.3 };
      var begun = Stopwatch.StartNew();
      var held = new Stopwatch();
      double most = 0.0;
      var answer = new Answer();
      while (begun.Elapsed.TotalSeconds < 60.0 && held.Elapsed.TotalSeconds < 3.5) {
        // Waits at the tool until it has all of its force (a check of its signs comes first), then goes down.
        if (answer.State == State.Live) { held.Start(); }
        var down = 0.004 * Share(held.Elapsed.TotalSeconds - 0.5);
        answer = gateway.Exchange(new[] { 0.0, -down, 0.0 }, new[] { 0.0, 0.0, 0.0, 1.0 });
        most = Math.Max(most, answer.Force[1]);
        Thread.Sleep(1);
      }
      var numbers = System.Globalization.CultureInfo.InvariantCulture;
      Console.WriteLine(string.Format(numbers, "force {0:F4} {1:F4} {2:F4} up to {3:F4}, at last {4}", answer.Force[0],
                                      answer.Force[1], answer.Force[2], most, answer.State));
    }
  }
}

}
