#include "dicom/dicom_library.h"

#include <cstdio>
#include <mutex>
#include <string>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>
#include <dcmtk/oflog/appender.h>
#include <dcmtk/oflog/oflog.h>
#include <dcmtk/oflog/spi/logevent.h>

namespace haustra::dicom {
namespace {

thread_local JpegWarnings warnings;

/// Writes nothing, and counts what libjpeg warns of, where pixels may be lost by it; a JFIF of
/// another revision costs none.
class WarningCounter : public dcmtk::log4cplus::Appender {
public:
    ~WarningCounter() override { destructorImpl(); }
    void close() override { closed = true; }

private:
    void append(const dcmtk::log4cplus::spi::InternalLoggingEvent& event) override {
        const std::string& told = event.getMessage();
        std::size_t bytes = 0;
        if (std::sscanf(told.c_str(), "Corrupt JPEG data: %zu extraneous bytes before marker 0xd9",
                        &bytes) == 1)
            warnings.bytesBeforeEnd += bytes;
        else if (told.find("Corrupt JPEG data") != std::string::npos ||
                 told.find("remature end") != std::string::npos)
            ++warnings.damages;
    }
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

JpegWarnings jpegWarnings() {
    return warnings;
}

}  // namespace haustra::dicom
