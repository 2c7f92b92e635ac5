#include "dicom/dicom_library.h"

#include <mutex>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>
#include <dcmtk/oflog/appender.h>
#include <dcmtk/oflog/oflog.h>

namespace haustra::dicom {
namespace {

thread_local std::size_t warnings = 0;

/// Writes nothing, and counts.
class WarningCounter : public dcmtk::log4cplus::Appender {
public:
    ~WarningCounter() override { destructorImpl(); }
    void close() override { closed = true; }

private:
    void append(const dcmtk::log4cplus::spi::InternalLoggingEvent&) override { ++warnings; }
};

}  // namespace

void prepareDicomLibrary() {
    static std::once_flag once;
    std::call_once(once, [] {
        OFLog::configure(OFLogger::WARN_LOG_LEVEL);
        dcmtk::log4cplus::Logger root = dcmtk::log4cplus::Logger::getRoot();
        root.removeAllAppenders();
        root.addAppender(dcmtk::log4cplus::SharedAppenderPtr(new WarningCounter));
        DcmRLEDecoderRegistration::registerCodecs();
        DJDecoderRegistration::registerCodecs();
        DJLSDecoderRegistration::registerCodecs();
    });
}

std::size_t libraryWarnings() {
    return warnings;
}

}  // namespace haustra::dicom
