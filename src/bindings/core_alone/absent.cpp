// Substitutes for functions that need libraries which the core-only build lacks: HDF5, pugixml,
// zlib and zstd. A case that needs one of them is refused with a message that names it.
#include "core_alone/missing_part.hpp"
#include "io/input_file.hpp"
#include "io/table_hdf5.hpp"
#include "output/event_file.hpp"
#include "output/scene.hpp"
#include "report/report_page.hpp"

namespace edmill {

namespace io {
Table<double>::Cells stored(const std::vector<std::string>&) { refuse("a table as .h5", "HDF5"); }
std::string hdf5_columns(const std::vector<StoredColumn>&, const std::vector<std::string>&,
    const std::vector<FileNote>&) {
  refuse("a table as .h5", "HDF5");
}
std::unique_ptr<Decoder> decoder_for(std::string_view beginning) {
  if (beginning.starts_with("\x1f\x8b")) refuse("a file compressed by gzip", "zlib");
  if (beginning.starts_with("\x28\xb5\x2f\xfd")) refuse("a file compressed by zstd", "zstd");
  return nullptr;
}
}  // namespace io

namespace output {
struct EventFile::Data {};
EventFile::EventFile(
    const std::filesystem::path&, std::vector<EventColumn>, const std::vector<io::FileNote>&) {
  refuse("an event log as .h5", "HDF5");
}
EventFile::~EventFile() = default;
// Never called, since the constructor throws.
void EventFile::add(std::size_t, std::int64_t) {}
void EventFile::add(std::size_t, double) {}
void EventFile::end_row() {}
void EventFile::add_table(const std::string&, const std::string&, const std::string&,
    const std::vector<double>&, std::size_t) {}
void EventFile::complete() {}
void EventFile::commit() {}
std::filesystem::path EventFile::place() const { return {}; }
void EventFile::archive(Archive&) {}

void look_at(const std::vector<model::Mesh>&, const std::vector<Frame<double>>&, Scene&) {
  refuse("a picture as X3D", "pugixml");
}
std::string x3d_text(const Scene&, const SceneMotion*) { refuse("a picture as X3D", "pugixml"); }
std::string vtp_balls(const Scene&) { refuse("a file for ParaView", "pugixml"); }
std::string vtp_vessel(const Scene&) { refuse("a file for ParaView", "pugixml"); }
std::string pvd_text(const std::vector<std::pair<double, std::vector<std::string>>>&) {
  refuse("a file for ParaView", "pugixml");
}
}  // namespace output

namespace report {
void add_report_outputs(casefile::CaseSpec&) { refuse("a report", "pugixml"); }
std::filesystem::path put_report(const std::filesystem::path&) { refuse("a report", "pugixml"); }
}  // namespace report

}  // namespace edmill
