#include "dicom/dicom_library.h"

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

thread_local std::size_t damages = 0;

/// Of what libjpeg warns of, whether pixels are lost; bytes that fill up what stands before the end
/// of image, or a JFIF of another revision, cost none.
bool tellsOfLostPixels(const std::string& warning) {
    const auto holds = [&](const char* words) { return warning.find(words) != std::string::npos; };
    return (holds("Corrupt JPEG data") || holds("remature end")) && !holds("before marker 0xd9");
}

/// Writes nothing, and counts.
class DamageCounter : public dcmtk::log4cplus::Appender {
public:
    ~DamageCounter() override { destructorImpl(); }
    void close() override { closed = true; }

private:
    void append(const dcmtk::log4cplus::spi::InternalLoggingEvent& event) override {
        damages += tellsOfLostPixels(event.getMessage());
    }
};

}  // namespace

void prepareDicomLibrary() {
    static std::once_flag once;
    std::call_once(once, [] {
        OFLog::configure(OFLogger::WARN_LOG_LEVEL);
        dcmtk::log4cplus::Logger root = dcmtk::log4cplus::Logger::getRoot();
        root.removeAllAppenders();
        root.addAppender(dcmtk::log4cplus::SharedAppenderPtr(new DamageCounter));
        DcmRLEDecoderRegistration::registerCodecs();
        DJDecoderRegistration::registerCodecs();
        DJLSDecoderRegistration::registerCodecs();
    });
}

std::size_t jpegDamages() {
    return damages;
}

}  // namespace haustra::dicom
