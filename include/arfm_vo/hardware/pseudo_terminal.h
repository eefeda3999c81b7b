#pragma once

#include <string>

#include "arfm_vo/hardware/file_descriptor.h"

namespace arfm_vo {

/// A serial line without hardware: what is written here is read from the device file `path`, and
/// the other way round. Closing it is unplugging the device.
class PseudoTerminal {
 public:
  /// Where `link` is not empty, a symbolic link of that name to the device file is made, in place
  /// of one to a pseudo terminal, as an earlier simulation leaves behind. Throws std::system_error,
  /// also where anything else has that name.
  explicit PseudoTerminal(const std::string& link = "");
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;

  /// The device file, or the link to it.
  const std::string& path() const { return path_; }
  /// The bytes that the other end wrote; waits for the first. Empty on timeout.
  std::string Read(double timeout_s);
  void Write(const std::string& bytes);

 private:
  std::string path_, link_, slave_;
  FileDescriptor master_;
  FileDescriptor keeper_;  ///< keeps the line up while no program has it open
};

}  // namespace arfm_vo
