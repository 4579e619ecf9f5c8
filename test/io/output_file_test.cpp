#include "semantic_mht_slam/io/output_file.h"

#include <csignal>
#include <filesystem>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "semantic_mht_slam/io/text_file.h"

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

std::ptrdiff_t entriesOf(const std::string& folder) {
  return std::distance(fs::directory_iterator(folder), {});
}

/// Files of this process cannot grow beyond a size, as on a disk that is full.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  void (*signal_)(int);
  rlimit before_{};
};

TEST(OutputFileTest, AppearsWithItsCommitAndPassesModeAndOwnerOn) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.txt";
  writeFileAtomically(path, "old");
  ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
  const bool is_root = ::geteuid() == 0;
  if (is_root) {
    ASSERT_EQ(::chown(path.c_str(), 12345, 54321), 0);
  }
  {
    OutputFile file(path);
    file.write("new");
    EXPECT_EQ(readFile(path), "old");
    EXPECT_EQ(entriesOf(folder.path()), 2) << "the temporary file is beside it";
    EXPECT_EQ(file.commit(), 3U);
  }
  EXPECT_EQ(readFile(path), "new");
  EXPECT_EQ(entriesOf(folder.path()), 1);
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
  if (is_root) {
    EXPECT_EQ(status.st_uid, 12345U);
    EXPECT_EQ(status.st_gid, 54321U);
  }
}

TEST(OutputFileTest, WithoutACommitNothingIsLeft) {
  const TemporaryFolder folder;
  writeFileAtomically(folder / "a.txt", "old");
  { OutputFile(folder / "a.txt").write("new"); }
  EXPECT_EQ(readFile(folder / "a.txt"), "old");
  EXPECT_EQ(entriesOf(folder.path()), 1);
}

TEST(OutputFileTest, LeftOversOfKilledProgramsGoAndWhatIsBeingWrittenStays) {
  const TemporaryFolder folder;
  const std::string left_over = folder / "a.txt.tmp-0123456789abcdef";
  const std::string in_use = folder / "a.txt.tmp-fedcba9876543210";
  const std::string other = folder / "a.txt.tmp-notes";
  for (const std::string& file : {left_over, in_use, other}) writeFileAtomically(file, "x");
  const int writer = ::open(in_use.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(writer, LOCK_EX), 0);
  writeFileAtomically(folder / "a.txt", "new");
  ::close(writer);
  EXPECT_FALSE(fs::exists(left_over));
  EXPECT_TRUE(fs::exists(in_use));
  EXPECT_TRUE(fs::exists(other)) << "somebody else's";
}

TEST(OutputFileTest, LinksFoldersAndPipesAreRefused) {
  const TemporaryFolder folder;
  writeFileAtomically(folder / "target", "precious");
  fs::create_symlink(folder / "target", folder / "link");
  expectInputError([&] { OutputFile file(folder / "link"); }, {folder / "link", "symbolic link"});
  fs::create_symlink(folder / "nothing", folder / "dangling");
  expectInputError([&] { OutputFile file(folder / "dangling"); }, {"symbolic link"});
  expectInputError([&] { OutputFile file(folder.path()); }, {folder.path(), "something else than a file"});
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  expectInputError([&] { OutputFile file(folder / "pipe"); }, {"something else than a file"});
  EXPECT_EQ(readFile(folder / "target"), "precious");
}

TEST(OutputFileTest, ErrorsHaveTheAbsolutePathAndTheReasonOfTheSystem) {
  const TemporaryFolder folder;
  expectInputError([&] { OutputFile file(folder / "none/a.txt"); },
                   {folder / "none/a.txt", "No such file or directory"});
  writeFileAtomically(folder / "file", "x");
  expectInputError([&] { OutputFile file(folder / "file/a.txt"); }, {folder / "file/a.txt", "it is not a folder"});
  expectInputError([&] { OutputFile file(folder / std::string(300, 'a')); }, {"File name too long"});
  expectInputError([&] { OutputFile file("no/such/a.txt"); }, {fs::current_path().string() + "/no/such/a.txt"});
  expectInputError([&] { OutputFile file(""); }, {"no file is named"});
  expectInputError([&] { OutputFile file("/proc/a.txt"); }, {"/proc/a.txt"});
}

TEST(OutputFileTest, AFullDiskHoldsNeitherFilesNorDescriptors) {
  const TemporaryFolder folder;
  writeFileAtomically(folder / "a.txt", "old");
  const std::ptrdiff_t descriptors = entriesOf("/proc/self/fd");
  {
    const SmallDisk disk(1000);
    for (int i = 0; i < 20; ++i) {
      expectInputError([&] { writeFileAtomically(folder / "a.txt", std::string(5000, 'x')); },
                       {folder / "a.txt", "File too large"});
    }
  }
  EXPECT_EQ(entriesOf("/proc/self/fd"), descriptors);
  EXPECT_EQ(entriesOf(folder.path()), 1);
  EXPECT_EQ(readFile(folder / "a.txt"), "old");
}

}  // namespace
}  // namespace semantic_mht_slam
