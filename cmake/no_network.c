/* In place of libcurl and libcrypto, for a wheel alone: Debian 13's archive of HDF5 asks for them to read files of a
 * cloud, which we never open. Without a handle from curl_easy_init HDF5 says that there is none. */
#pragma GCC visibility push(hidden)
int curl_global_init(long flags) { return (void)flags, 0; }
void curl_global_cleanup(void) {}
void* curl_easy_init(void) { return 0; }
void curl_easy_cleanup(void* handle) { (void)handle; }
int curl_easy_perform(void* handle) { return (void)handle, 2; }
int curl_easy_setopt(void* handle, int option, ...) { return (void)handle, (void)option, 2; }
void* curl_slist_append(void* list, const char* text) { return (void)list, (void)text, (void*)0; }
void curl_slist_free_all(void* list) { (void)list; }
const void* EVP_sha256(void) { return 0; }
unsigned char* HMAC(void) { return 0; }
unsigned char* SHA256(void) { return 0; }
