#include "core/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <system_error>
#include <vector>

#include "core/types.h"

namespace lanewise {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, int error) {
  const std::string what = path + ": cannot write: " + std::generic_category().message(error);
  if (error == EPIPE) throw BrokenPipe(what);
  throw Error(what);
}

// The file that a path stands for. Links to devices and pipes stay as they are: /dev/stdout has no other name.
fs::path target_of(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_symlink(path, ignored)) return path;
  if (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored)) return path;
  return fs::weakly_canonical(path, ignored);
}

fs::path folder_of(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : fs::path("."); }

// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool open() const { return fd_ >= 0; }
  int sync() { return ::fsync(fd_) == 0 ? 0 : errno; }
  int close() {
    const int result = fd_ >= 0 && ::close(fd_) != 0 ? errno : 0;
    fd_ = -1;
    return result;
  }
  int write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
      if (written < 0 && errno != EINTR) return errno;
      if (written > 0) bytes.remove_prefix(static_cast<size_t>(written));
    }
    return 0;
  }
  // Appends what is left of the file.
  int read(std::string& bytes, uint64_t max_bytes) {
    std::vector<char> chunk(size_t{1} << 20);
    for (;;) {
      const ssize_t n = ::read(fd_, chunk.data(), chunk.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return errno;
      if (n == 0) return 0;
      if (bytes.size() + static_cast<size_t>(n) > max_bytes) return EFBIG;
      bytes.append(chunk.data(), static_cast<size_t>(n));
    }
  }

 private:
  int fd_;
};

// A name of its own in the folder: short, so that it fits wherever the target's name does.
fs::path temporary_in(const fs::path& folder) {
  char name[32];
  std::snprintf(name, sizeof name, ".lanewise-%08x.tmp", std::random_device()());
  return folder / name;
}

void write_directly(const std::string& path, const fs::path& target, std::string_view bytes) {
  Descriptor file(target, O_WRONLY);
  if (!file.open()) fail(path, errno);
  if (const int error = file.write(bytes)) fail(path, error);
  if (const int error = file.close()) fail(path, error);
}

}  // namespace

void check_writable(const std::string& path) {
  const fs::path target = target_of(path);
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status)) throw Error(path + ": cannot write: it is a folder");
  if (status.type() == fs::file_type::none) fail(path, error.value());
  if (target.filename().empty()) throw Error(path + ": cannot write: no file name");
  if (fs::exists(status) && ::access(target.c_str(), W_OK) != 0) fail(path, errno);
  if (fs::exists(status) && !fs::is_regular_file(status)) return;
  const fs::path folder = folder_of(target);
  if (!fs::is_directory(folder, error)) throw Error(path + ": cannot write: no folder " + folder.string());
  if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(path, errno);
}

void write_file(const std::string& path, std::string_view bytes) {
  check_writable(path);
  const fs::path target = target_of(path);
  std::error_code ignored;
  if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored)) return write_directly(path, target, bytes);

  const fs::path folder = folder_of(target);
  const fs::path temporary = temporary_in(folder);
  Descriptor file(temporary, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW);
  if (!file.open()) fail(path, errno);
  int error = file.write(bytes);
  if (error == 0) error = file.sync();
  if (error == 0) error = file.close();
  if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    fail(path, error);
  }
  // The name is safe on disk only once its folder is; file systems that cannot sync folders are none the worse for it.
  Descriptor entry(folder, O_RDONLY | O_DIRECTORY);
  if (entry.open()) entry.sync();
}

FileLock::FileLock(const std::string& path) : lock_(target_of(path).string() + ".lock"), fd_(-1) {
  for (;;) {
    fd_ = ::open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (fd_ < 0) fail(lock_, errno);
    if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      ::close(fd_);
      if (error == EWOULDBLOCK) throw Error(path + ": another render is writing it");
      fail(lock_, error);
    }
    // Whoever had it may have removed the name just now: then the lock is on a file that nobody else will find.
    struct stat by_name, locked;
    if (::stat(lock_.c_str(), &by_name) == 0 && ::fstat(fd_, &locked) == 0 && by_name.st_ino == locked.st_ino) return;
    ::close(fd_);
  }
}

FileLock::~FileLock() {
  ::unlink(lock_.c_str());
  ::close(fd_);
}

std::string read_file(const std::string& path, uint64_t max_bytes) {
  Descriptor file(path, O_RDONLY);
  if (!file.open()) throw Error(std::generic_category().message(errno));
  std::string bytes;
  if (const int error = file.read(bytes, max_bytes)) throw Error(std::generic_category().message(error));
  return bytes;
}

}  // namespace lanewise
